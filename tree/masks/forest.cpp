#include "tree/masks/forest.h"

#include "tree/masks/constants.h"
#include "tree/masks/masks.h"
#include "tree/masks/winding.h"
#include "tree/part.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// The triangles of each body, in their order.
std::vector<std::vector<std::uint32_t>> triangles_of(
    std::span<const std::uint32_t> body_of_triangle, std::uint32_t bodies)
{
    std::vector<std::vector<std::uint32_t>> triangles(bodies);
    for (std::size_t t = 0; t < body_of_triangle.size(); ++t)
        triangles[body_of_triangle[t]].push_back(static_cast<std::uint32_t>(t));
    return triangles;
}

/// Cuts bodies out of a geometry.
class BodyCutter {
public:
    explicit BodyCutter(const Geometry& geometry)
        : geometry_(geometry),
          vertex_of_(geometry.positions.size(), kNowhere),
          welded_of_(geometry.positions.size(), kNowhere)
    {
    }

    /// What a tree asks of a geometry. vertices: which they were.
    Geometry cut(std::span<const std::uint32_t> triangles, std::vector<std::uint32_t>& vertices)
    {
        Geometry body;
        body.frame = geometry_.frame;
        body.triangles.reserve(triangles.size());
        for (const std::uint32_t t : triangles) {
            glm::uvec3 corners = geometry_.triangles[t];
            for (int k = 0; k < 3; ++k)
                corners[k] = vertex_of(corners[k], body, vertices);
            body.triangles.push_back(corners);
        }
        for (const std::uint32_t vertex : vertices) {
            vertex_of_[vertex] = kNowhere;
            welded_of_[geometry_.welded[vertex]] = kNowhere;
        }
        return body;
    }

private:
    static constexpr std::uint32_t kNowhere = ~0u;

    std::uint32_t vertex_of(std::uint32_t vertex, Geometry& body,
                            std::vector<std::uint32_t>& vertices)
    {
        std::uint32_t& place = vertex_of_[vertex];
        if (place != kNowhere)
            return place;
        place = static_cast<std::uint32_t>(vertices.size());
        std::uint32_t& welded = welded_of_[geometry_.welded[vertex]];
        if (welded == kNowhere)
            welded = place;
        vertices.push_back(vertex);
        body.positions.push_back(geometry_.positions[vertex]);
        body.normals.push_back(geometry_.normals[vertex]);
        body.welded.push_back(welded);
        return place;
    }

    const Geometry& geometry_;
    std::vector<std::uint32_t> vertex_of_;  ///< in the body that is cut
    std::vector<std::uint32_t> welded_of_;  ///< the body's first vertex at a place
};

/// About the middle of the box of all corners.
MaskBall ball_of(const Geometry& geometry)
{
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::uvec3 t : geometry.triangles) {
        for (int k = 0; k < 3; ++k) {
            low = glm::min(low, geometry.positions[t[k]]);
            high = glm::max(high, geometry.positions[t[k]]);
        }
    }
    if (geometry.triangles.empty())
        return {};
    const glm::vec3 middle = 0.5f * (low + high);
    float radius2 = 0.0f;
    for (const glm::uvec3 t : geometry.triangles) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 from = geometry.positions[t[k]] - middle;
            radius2 = std::max(radius2, glm::dot(from, from));
        }
    }
    return {kMaskFrame * middle, std::sqrt(radius2)};
}

/// A placement as it is in the mask frame.
struct MaskPlacement {
    glm::dmat3 linear;
    glm::dvec3 translation;
    float scale;
    bool mirrors;

    explicit MaskPlacement(const Placement& placement)
        : scale(static_cast<float>(placement.scale)),
          mirrors(glm::determinant(placement.rotation) < 0.0)
    {
        // the frame is orthonormal to 1e-7 only: its inverse, not its transpose
        const glm::dmat3 frame(kMaskFrame);
        linear = placement.scale * (frame * placement.rotation * glm::inverse(frame));
        translation = frame * placement.translation;
    }
    glm::vec3 at(glm::vec3 point) const
    {
        return glm::vec3(linear * glm::dvec3(point) + translation);
    }
};

MaskBall placed_ball(const MaskBall& ball, const Placement& placement)
{
    const MaskPlacement to(placement);
    return {to.at(ball.center), to.scale * ball.radius};
}

}  // namespace

void place_nodes(std::span<const MaskNode> at_rest, const Placement& placement, std::uint32_t base,
                 MaskNode* nodes)
{
    const bool stays = placement == Placement{};
    const MaskPlacement to(placement);
    const glm::mat3 linear(to.linear);
    // what is mirrored runs round the other way, but for its first half axis
    const float turn = to.mirrors ? -1.0f : 1.0f;
    for_blocks(at_rest, [&](std::span<const MaskNode> block, std::size_t block_index) {
        MaskNode* out = nodes + block_index * kPartBlock;
        for (const MaskNode& node : block) {
            *out = node;
            if ((node.links & kMaskFirstChild) != 0)
                out->links += base;
            if (!stays) {
                out->center = to.at(node.center);
                out->radius *= to.scale;
                out->skew = linear * node.skew;
                out->thickness *= to.scale;
                out->axis_a = turn * (linear * node.axis_a);
                out->axis_b = linear * node.axis_b;
                if (node.open_radius > 0.0f)
                    out->open_radius *= to.scale;
            }
            ++out;
        }
    });
}

MaskForest::MaskForest(const Geometry& geometry, std::span<const std::uint32_t> body_of_triangle,
                       std::uint32_t bodies)
    : bodies_(bodies)
{
    const auto triangles = triangles_of(body_of_triangle, bodies);
    BodyCutter cutter(geometry);
    for (std::uint32_t k = 0; k < bodies; ++k) {
        const bool is_all = triangles[k].size() == geometry.triangles.size();
        if (is_all && k == 0)
            bodies_[k].at_rest = geometry;
        else
            bodies_[k].at_rest = cutter.cut(triangles[k], bodies_[k].vertices);
    }
    tbb::parallel_for(std::uint32_t{0}, bodies, [&](std::uint32_t k) {
        Body& body = bodies_[k];
        // once, not for each form that it takes
        if (k != 0 && is_winding_mixed(body.at_rest))
            wind_alike(body.at_rest);
        body.rest_nodes = build_mask_tree(body.at_rest)->nodes;
        body.rest_ball = body.ball = ball_of(body.at_rest);
    });
    lay_out();
    settle();
    bodies_[0].at_rest = {};
    bodies_[0].vertices = {};
    bodies_[0].rest_nodes = {};
}

std::uint32_t MaskForest::body_count() const
{
    return static_cast<std::uint32_t>(bodies_.size());
}

void MaskForest::change(Body& body)
{
    ++body.version;
    body.settled = false;
}

void MaskForest::place(std::uint32_t body, const Placement& placement)
{
    Body& of = bodies_[body];
    of.placement = placement;
    of.form_nodes = {};
    change(of);
}

void MaskForest::hide(std::uint32_t body)
{
    Body& of = bodies_[body];
    of.placement.reset();
    of.form_nodes = {};
    change(of);
}

/// Of a form of the body, as it follows from that form alone.
RawVector<MaskNode> MaskForest::nodes_of(Body& body, const Geometry& form)
{
    const auto planned = [&](std::optional<MaskPlan>& plan, MaskPairs pairs) -> const MaskPlan& {
        if (!plan)
            static_cast<void>(build_mask_nodes(body.at_rest, pairs, plan.emplace()));
        return *plan;
    };
    if (auto nodes = refit_mask_nodes(planned(body.plan, MaskPairs::found), form))
        return std::move(*nodes);
    if (auto nodes = refit_mask_nodes(planned(body.plan_without_pairs, MaskPairs::none), form))
        return std::move(*nodes);
    MaskPlan unused;
    return build_mask_nodes(form, MaskPairs::found, unused);
}

void MaskForest::deform(std::uint32_t body, std::span<const glm::vec3> positions)
{
    Body& of = bodies_[body];
    of.placement = Placement{};
    Geometry form = of.at_rest;
    for (std::size_t i = 0; i < of.vertices.size(); ++i)
        form.positions[i] = positions[of.vertices[i]];
    of.form_nodes = nodes_of(of, form);
    of.form_ball = ball_of(form);
    change(of);
}

/// Places in nodes_ for all bodies, as many as each has needed so far.
void MaskForest::lay_out()
{
    std::uint64_t count = 0;
    for (Body& body : bodies_) {
        const std::size_t needed = std::max(body.rest_nodes.size(), body.form_nodes.size());
        // body 0 gives its nodes at rest away: they stand where they are
        body.capacity = std::max(body.capacity, static_cast<std::uint32_t>(needed));
        body.base = static_cast<std::uint32_t>(count);
        count += body.capacity;
        body.settled = false;
    }
    check_mask_tiles((count + 1) / 2, count / 2);
    RawVector<MaskNode> nodes;
    nodes.resize(count);
    // body 0 comes first, and stays so
    std::copy_n(nodes_.begin(), nodes_.empty() ? 0 : bodies_[0].capacity, nodes.begin());
    nodes_ = std::move(nodes);
}

void MaskForest::settle()
{
    if (std::ranges::any_of(
            bodies_, [](const Body& body) { return body.form_nodes.size() > body.capacity; }))
        lay_out();
    tbb::parallel_for(std::size_t{0}, bodies_.size(), [&](std::size_t k) {
        if (!bodies_[k].settled)
            settle(bodies_[k]);
    });
}

void MaskForest::settle(Body& body)
{
    body.settled = true;
    if (!body.placement)
        return;
    const bool is_formed = !body.form_nodes.empty();
    place_nodes(is_formed ? body.form_nodes : body.rest_nodes, *body.placement, body.base,
                nodes_.data() + body.base);
    const MaskBall& ball = is_formed ? body.form_ball : body.rest_ball;
    body.ball = *body.placement == Placement{} ? ball : placed_ball(ball, *body.placement);
}

std::optional<std::uint32_t> MaskForest::root(std::uint32_t body) const
{
    const Body& of = bodies_[body];
    return of.placement && of.capacity > 0 ? std::optional(of.base) : std::nullopt;
}

std::vector<std::uint32_t> MaskForest::roots() const
{
    std::vector<std::uint32_t> roots;
    for (std::uint32_t body = 0; body < body_count(); ++body) {
        if (const auto at = root(body))
            roots.push_back(*at);
    }
    return roots;
}

const MaskBall& MaskForest::ball(std::uint32_t body) const
{
    return bodies_[body].ball;
}

std::uint64_t MaskForest::version(std::uint32_t body) const
{
    return bodies_[body].version;
}

const std::optional<Placement>& MaskForest::placement(std::uint32_t body) const
{
    return bodies_[body].placement;
}

}  // namespace surfelao
