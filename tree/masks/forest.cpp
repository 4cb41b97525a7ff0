#include "tree/masks/forest.h"

#include "surfels/for_all.h"
#include "tree/masks/constants.h"
#include "tree/masks/masks.h"
#include "tree/masks/winding.h"
#include "tree/part.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace surfelao {
namespace {

/// What a tree asks of a geometry, of one body. first_at: room for one per vertex of the geometry.
Geometry geometry_of(const Geometry& geometry, BodyMesh& body, std::vector<std::uint32_t>& first_at)
{
    Geometry own;
    own.frame = geometry.frame;
    own.triangles = std::move(body.triangles);
    // welded: the body's first vertex at a place
    for (std::size_t i = body.vertices.size(); i-- > 0;)
        first_at[geometry.welded[body.vertices[i]]] = static_cast<std::uint32_t>(i);
    for (const std::uint32_t vertex : body.vertices) {
        own.positions.push_back(geometry.positions[vertex]);
        own.normals.push_back(geometry.normals[vertex]);
        own.welded.push_back(first_at[geometry.welded[vertex]]);
    }
    return own;
}

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
    if (placement == Placement{})
        return ball;
    const MaskPlacement to(placement);
    return {to.at(ball.center), to.scale * ball.radius};
}

/// Nodes to where a body is placed.
class NodePlacer {
public:
    /// base: what is added to links.
    NodePlacer(const Placement& placement, std::uint32_t base)
        : stays_(placement == Placement{}),
          base_(base),
          to_(placement),
          linear_(to_.linear),
          turn_(to_.mirrors ? -1.0f : 1.0f)
    {
    }

    MaskNode operator()(const MaskNode& node) const
    {
        MaskNode out = node;
        if ((node.links & kMaskFirstChild) != 0)
            out.links += base_;
        if (stays_)
            return out;
        out.center = to_.at(node.center);
        out.radius *= to_.scale;
        out.skew = linear_ * node.skew;
        out.thickness *= to_.scale;
        out.axis_a = turn_ * (linear_ * node.axis_a);
        out.axis_b = linear_ * node.axis_b;
        if (node.open_radius > 0.0f)
            out.open_radius *= to_.scale;
        return out;
    }

private:
    bool stays_;
    std::uint32_t base_;
    MaskPlacement to_;
    glm::mat3 linear_;
    float turn_;  ///< what is mirrored runs round the other way, but for its first half axis
};

/// Whether no group in a viewer's ball ever looks at the children of a node. The kernels' walk
/// opens no node that is smaller than its cluster as seen from the nearest of a group.
bool is_never_opened(const MaskForest::View& view, const MaskNode& node)
{
    constexpr float kRounding = 1.0f - 1e-4f;
    if ((node.links & kMaskFirstChild) == 0)
        return true;
    const float nearest = glm::distance(node.center, view.ball.center) - view.ball.radius;
    return node.open_radius < view.cluster * nearest * kRounding ||
           kRounding * (nearest - node.radius) > view.limit;
}

/// Below each of `open`, a node that is placed and opened, as far as the viewer looks.
class SubtreePlacer {
public:
    SubtreePlacer(const MaskForest::View& view, const NodePlacer& placer,
                  std::span<const MaskNode> at_rest, MaskNode* nodes)
        : view_(view), placer_(placer), at_rest_(at_rest), nodes_(nodes)
    {
    }

    void run() const
    {
        std::vector<std::uint32_t> open;
        place(0, open);
        // level by level until there is enough for all threads
        while (!open.empty() && open.size() < kTasks) {
            std::vector<std::uint32_t> below;
            for (const std::uint32_t i : open)
                place_children(i, below);
            open = std::move(below);
        }
        for_tasks(open.size(), [&](std::size_t i) {
            std::vector<std::uint32_t> left{open[i]};
            while (!left.empty()) {
                const std::uint32_t node = left.back();
                left.pop_back();
                place_children(node, left);
            }
        });
    }

private:
    static constexpr std::size_t kTasks = 64;

    /// Appends it where it is opened.
    void place(std::uint32_t i, std::vector<std::uint32_t>& open) const
    {
        nodes_[i] = placer_(at_rest_[i]);
        if (!is_never_opened(view_, nodes_[i]))
            open.push_back(i);
    }
    void place_children(std::uint32_t i, std::vector<std::uint32_t>& open) const
    {
        const std::uint32_t child = at_rest_[i].links & kMaskFirstChild;
        place(child, open);
        place(child + 1, open);
    }

    const MaskForest::View& view_;
    const NodePlacer& placer_;
    std::span<const MaskNode> at_rest_;
    MaskNode* nodes_;
};

}  // namespace

MaskForest::MaskForest(const Geometry& geometry, std::vector<BodyMesh> bodies)
    : bodies_(bodies.size())
{
    std::vector<std::uint32_t> first_at(geometry.positions.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        bodies_[k].at_rest =
            bodies.size() == 1 ? geometry : geometry_of(geometry, bodies[k], first_at);
        bodies_[k].vertices = std::move(bodies[k].vertices);
    }
    for_tasks(bodies_.size(), [&](std::size_t k) {
        Body& body = bodies_[k];
        // once, not for each form that it takes
        if (k != 0 && is_winding_mixed(body.at_rest))
            wind_alike(body.at_rest);
        body.rest_nodes = build_mask_tree(body.at_rest)->nodes;
        body.rest_ball = ball_of(body.at_rest);
    });
    lay_out();
    static_cast<void>(nodes());
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
RawVector<MaskNode> MaskForest::bent(Body& body, const Geometry& form)
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
    return build_mask_nodes(form);
}

void MaskForest::deform(std::uint32_t body, std::span<const glm::vec3> positions)
{
    Body& of = bodies_[body];
    of.placement = Placement{};
    Geometry form = of.at_rest;
    for (std::size_t i = 0; i < of.vertices.size(); ++i)
        form.positions[i] = positions[of.vertices[i]];
    of.form_nodes = bent(of, form);
    of.form_ball = ball_of(form);
    change(of);
    if (of.form_nodes.size() > of.capacity)
        lay_out();
}

/// Places in nodes_ for all bodies, as many as each has needed so far.
void MaskForest::lay_out()
{
    std::uint64_t count = 0;
    for (Body& body : bodies_) {
        const std::size_t needed = std::max(body.rest_nodes.size(), body.form_nodes.size());
        body.capacity = std::max(body.capacity, static_cast<std::uint32_t>(needed));
        body.base = static_cast<std::uint32_t>(count);
        count += body.capacity;
        body.settled = false;
    }
    check_mask_tiles((count + 1) / 2, count / 2);
    nodes_.resize(count);
}

const MaskNode* MaskForest::nodes() const
{
    const std::lock_guard lock(settling_);
    // a thread that waits here must not take up work that asks for the nodes
    tbb::this_task_arena::isolate([&] {
        for_tasks(bodies_.size(), [&](std::size_t k) {
            if (!std::exchange(bodies_[k].settled, true) && bodies_[k].placement)
                settle(bodies_[k]);
        });
    });
    return nodes_.data();
}

void MaskForest::settle(const Body& body) const
{
    const NodePlacer placer(*body.placement, body.base);
    const auto& nodes = body.form_nodes.empty() ? body.rest_nodes : body.form_nodes;
    for_blocks(std::span(nodes), [&](std::span<const MaskNode> block, std::size_t i) {
        std::transform(block.begin(), block.end(), nodes_.data() + body.base + i * kPartBlock,
                       placer);
    });
}

std::span<const MaskNode> MaskForest::nodes_of(const Body& body) const
{
    if (&body == bodies_.data())
        return {nodes_.data(), body.capacity};
    return body.form_nodes.empty() ? body.rest_nodes : body.form_nodes;
}

MaskBall MaskForest::ball_before(std::uint32_t viewer, std::uint32_t body) const
{
    return placed_ball(bodies_[body].ball(),
                       inverse(*bodies_[viewer].placement) * *bodies_[body].placement);
}

void MaskForest::place_before(const View& view, std::span<const std::uint32_t> bodies,
                              RawVector<MaskNode>& nodes) const
{
    nodes.resize(nodes_.size());
    const Placement back = inverse(*bodies_[view.viewer].placement);
    for_tasks(bodies.size(), [&](std::size_t k) {
        const Body& body = bodies_[bodies[k]];
        const NodePlacer placer(bodies[k] == view.viewer ? Placement{} : back * *body.placement,
                                body.base);
        SubtreePlacer(view, placer, nodes_of(body), nodes.data() + body.base).run();
    });
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

bool MaskForest::is_deformed(std::uint32_t body) const
{
    return !bodies_[body].form_nodes.empty();
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
