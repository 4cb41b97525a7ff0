#include "bake/fit_cells.h"

#include "surfels/edges.h"
#include "surfels/for_all.h"
#include "surfels/union_find.h"
#include "tree/discard.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Triangles lie in one plane when their normals agree to this (a quarter of a degree).
constexpr double kOnePlane = 1.0 - 1e-5;

/// Radians: a corner of a quad is this far from straight, and the best neighbour is better than the
/// next one by as much.
constexpr double kClearly = 0.01;

/// Corners in order; the diagonal that the mesh has runs from the first to the third.
///
///        d ------- c
///        |  second/|
///        |   /     |
///        |/ first  |
///        a ------- b
struct Quad {
    std::array<glm::dvec3, 4> places;
    std::array<std::uint32_t, 2> triangles{};
    std::array<int, 2> turns{};  ///< the triangles' corners that lie at a
    glm::uvec4 unknowns{0};
};

double angle_at(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b)
{
    return std::atan2(glm::length(glm::cross(a - p, b - p)), glm::dot(a - p, b - p));
}

/// Twice the area of a, b, c, with a sign: positive where they turn as `normal` has it.
double turn(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 normal)
{
    return glm::dot(glm::cross(b - a, c - a), normal);
}

class QuadFinder {
public:
    /// among: rising.
    QuadFinder(const Geometry& geometry, std::span<const std::uint32_t> unknowns,
               const std::vector<std::uint32_t>& among)
        : geometry_(geometry), unknowns_(unknowns), edges_(geometry)
    {
        std::vector<std::uint32_t> best;
        for (const std::uint32_t t : among)
            best.push_back(best_neighbour(t));
        for (std::size_t i = 0; i < among.size(); ++i) {
            const auto other = std::ranges::lower_bound(among, best[i]);
            if (other != among.end() && *other == best[i] && among[i] < best[i] &&
                best[static_cast<std::size_t>(other - among.begin())] == among[i])
                quads.push_back(*quad_of(among[i], best[i]));
        }
    }

    std::vector<Quad> quads;  ///< by rising first triangle

private:
    std::uint32_t vertex(std::uint32_t triangle, int corner) const
    {
        return geometry_.triangles[triangle][corner % 3];
    }
    std::uint32_t unknown(std::uint32_t triangle, int corner) const
    {
        return unknowns_[vertex(triangle, corner)];
    }
    glm::dvec3 place(std::uint32_t triangle, int corner) const
    {
        return geometry_.positions[vertex(triangle, corner)];
    }

    /// The one triangle on the other side of a side, and its side; kNone where there is none or
    /// more, or it does not share both unknowns.
    Side across(std::uint32_t triangle, int side) const
    {
        const std::uint32_t from = geometry_.welded[vertex(triangle, side)];
        const std::uint32_t to = geometry_.welded[vertex(triangle, side + 1)];
        Side found = kNone;
        int count = 0;
        for (const EdgeSide& other : edges_.at(std::min(from, to))) {
            if (other.upper != std::max(from, to))
                continue;
            ++count;
            if (other.triangle() != triangle && other.rises() == (to < from))
                found = other.side();
        }
        if (count != 2 || found == kNone)
            return kNone;
        const int back = static_cast<int>(found % 3);
        const bool shared = unknown(found / 3, back) == unknown(triangle, side + 1) &&
                            unknown(found / 3, back + 1) == unknown(triangle, side);
        return shared ? found : kNone;
    }

    /// Of t and the triangle beyond its side; empty where they make none.
    std::optional<Quad> quad_over(std::uint32_t t, int side) const
    {
        const Side found = across(t, side);
        if (found == kNone)
            return std::nullopt;
        const std::uint32_t other = found / 3;
        const int back = static_cast<int>(found % 3);
        // t's side runs from c to a, the other's from a to c
        Quad quad;
        quad.triangles = {t, other};
        quad.turns = {(side + 1) % 3, back};
        quad.places = {place(t, side + 1), place(t, side + 2), place(t, side),
                       place(other, back + 2)};
        quad.unknowns = {unknown(t, side + 1), unknown(t, side + 2), unknown(t, side),
                         unknown(other, back + 2)};
        return quad;
    }

    std::optional<Quad> quad_of(std::uint32_t t, std::uint32_t other) const
    {
        for (int side = 0; side < 3; ++side) {
            const std::optional<Quad> quad = quad_over(t, side);
            if (quad && quad->triangles[1] == other)
                return quad;
        }
        return std::nullopt;
    }

    /// How far its worst angle is from a right one; empty where it is not planar and convex.
    static std::optional<double> skew_of(const Quad& quad)
    {
        const auto& [a, b, c, d] = quad.places;
        const glm::dvec3 first = glm::normalize(glm::cross(b - a, c - a));
        const glm::dvec3 second = glm::normalize(glm::cross(c - a, d - a));
        if (!(glm::dot(first, second) >= kOnePlane))
            return std::nullopt;
        const double at_a = angle_at(a, b, c) + angle_at(a, c, d);
        const double at_c = angle_at(c, a, b) + angle_at(c, d, a);
        if (std::max(at_a, at_c) > std::numbers::pi - kClearly)
            return std::nullopt;
        double skew = 0.0;
        for (const double angle : {at_a, angle_at(b, a, c), at_c, angle_at(d, a, c)})
            skew = std::max(skew, std::abs(angle - 0.5 * std::numbers::pi));
        return skew;
    }

    std::uint32_t best_neighbour(std::uint32_t t) const
    {
        std::uint32_t best = kNone;
        double least = std::numeric_limits<double>::max(), next = least;
        for (int side = 0; side < 3; ++side) {
            const std::optional<Quad> quad = quad_over(t, side);
            const std::optional<double> skew = quad ? skew_of(*quad) : std::nullopt;
            if (!skew)
                continue;
            if (*skew < least) {
                next = std::exchange(least, *skew);
                best = quad->triangles[1];
            } else {
                next = std::min(next, *skew);
            }
        }
        return next - least >= kClearly ? best : kNone;
    }

    const Geometry& geometry_;
    std::span<const std::uint32_t> unknowns_;
    Edges edges_;
};

class Sampler {
public:
    explicit Sampler(SurfaceSamples& samples) : samples_(samples) {}

    void add_quad(const Quad& quad, std::uint32_t rows, double area)
    {
        samples_.quads.push_back(quad.unknowns);
        samples_.first_sample.push_back(static_cast<std::uint32_t>(samples_.points.size()));
        const auto& [a, b, c, d] = quad.places;
        const std::size_t first = samples_.areas.size();
        if (rows == 1) {
            for (int second = 0; second < 2; ++second) {
                const glm::dvec3& tip = second == 0 ? b : d;
                const double tip_share = 1.0 / 3.0 + static_cast<double>(kSampleShift[0]);
                const double a_share = 1.0 / 3.0 + static_cast<double>(kSampleShift[1]);
                add_sample(quad, a_share * a + tip_share * tip + (1.0 - a_share - tip_share) * c);
                samples_.areas.push_back(
                    static_cast<float>(0.5 * glm::length(glm::cross(c - a, tip - a))));
            }
            return;
        }
        double sum = 0.0;
        for (std::uint32_t i = 0; i < rows; ++i) {
            for (std::uint32_t j = 0; j < rows; ++j) {
                const double u = (i + 0.5 + static_cast<double>(kSampleShift[0])) / rows;
                const double v = (j + 0.5 + static_cast<double>(kSampleShift[1])) / rows;
                const glm::dvec3 low = a + u * (b - a), high = d + u * (c - d);
                const double stretch =
                    glm::length(glm::cross((1.0 - v) * (b - a) + v * (c - d), high - low));
                add_sample(quad, low + v * (high - low));
                samples_.areas.push_back(static_cast<float>(stretch));
                sum += stretch;
            }
        }
        for (std::size_t s = first; s < samples_.areas.size(); ++s)
            samples_.areas[s] *= static_cast<float>(area / sum);
    }

private:
    /// Weights of three corners of a quad at p, which lies in their plane.
    static glm::dvec4 weights_at(const Quad& quad, std::array<int, 3> corners, glm::dvec3 p,
                                 glm::dvec3 normal)
    {
        const auto place = [&](int i) {
            return quad.places[static_cast<std::size_t>(corners[static_cast<std::size_t>(i % 3)])];
        };
        const double whole = turn(place(0), place(1), place(2), normal);
        glm::dvec4 weights(0.0);
        for (int i = 0; i < 3; ++i)
            weights[corners[static_cast<std::size_t>(i)]] =
                turn(place(i + 1), place(i + 2), p, normal) / whole;
        return weights;
    }

    void add_sample(const Quad& quad, glm::dvec3 p)
    {
        const auto& [a, b, c, d] = quad.places;
        const glm::dvec3 normal = glm::cross(c - a, d - b);
        const bool in_second = turn(a, c, p, normal) > 0.0;
        const bool beyond = turn(b, d, p, normal) > 0.0;  // towards a
        const glm::dvec4 own = in_second ? weights_at(quad, {0, 2, 3}, p, normal)
                                         : weights_at(quad, {0, 1, 2}, p, normal);
        const glm::dvec4 other = beyond ? weights_at(quad, {0, 1, 3}, p, normal)
                                        : weights_at(quad, {1, 2, 3}, p, normal);
        samples_.quad_weights.emplace_back(0.5 * (own + other));
        // corners of the triangle, from the one at a on
        const glm::dvec3 weights =
            in_second ? glm::dvec3(own[0], own[2], own[3]) : glm::dvec3(own[0], own[1], own[2]);
        const int at_a = quad.turns[in_second];
        glm::dvec3 turned;
        for (int i = 0; i < 3; ++i)
            turned[(at_a + i) % 3] = weights[i];
        samples_.points.push_back(
            {quad.triangles[in_second],
             glm::clamp(glm::vec2(turned.y, turned.z), glm::vec2(0.0f), glm::vec2(1.0f))});
    }

    SurfaceSamples& samples_;
};

/// How many samples so many triangles have together.
double wanted_of(std::size_t triangles)
{
    const std::uint64_t count = triangles;
    return static_cast<double>(
        std::max(std::min<std::uint64_t>(kFewestSamples, kMostSamplesEach * count), count));
}

/// Rows of samples of a triangle, or of any shape on the same piece, by its area.
class Density {
public:
    Density(const Geometry& geometry, std::span<const double> areas)
        : geometry_(geometry), piece_at_(geometry.positions.size())
    {
        UnionFind joined(piece_at_.size());
        for_all(geometry.triangles.size(), [&](std::size_t i) {
            const glm::uvec3 t = geometry.triangles[i];
            joined.join(geometry.welded[t.x], geometry.welded[t.y]);
            joined.join(geometry.welded[t.y], geometry.welded[t.z]);
        });
        for_all(piece_at_.size(), [&](std::size_t place) {
            piece_at_[place] = joined.root(static_cast<std::uint32_t>(place));
        });
        struct Piece {
            double area = 0.0;
            std::size_t triangles = 0;
        };
        std::vector<Piece> pieces(geometry.positions.size());
        double area = 0.0;
        for (std::uint32_t t = 0; t < areas.size(); ++t) {
            Piece& piece = pieces[piece_of(t)];
            piece.area += areas[t];
            ++piece.triangles;
            area += areas[t];
        }
        // pieces of few triangles want many samples each: no more than all together may have
        double wanted = 0.0;
        for (const Piece& piece : pieces)
            wanted += piece.triangles > 0 ? wanted_of(piece.triangles) : 0.0;
        const auto count = static_cast<double>(areas.size());
        const double most = count + static_cast<double>(kMoreByPiece);
        const double extra = wanted > most ? (most - count) / (wanted - count) : 1.0;
        per_area_ = area > 0.0 ? wanted_of(areas.size()) / area : 0.0;
        per_area_of_.resize(pieces.size(), 0.0);
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            if (pieces[p].triangles == 0)
                continue;
            const auto own = static_cast<double>(pieces[p].triangles);
            const double share = own + extra * (wanted_of(pieces[p].triangles) - own);
            per_area_of_[p] = std::max(per_area_, share / pieces[p].area);
        }
    }

    std::uint32_t rows_of(std::uint32_t triangle, double area) const
    {
        const double rows = std::round(std::sqrt(per_area_of_[piece_of(triangle)] * area));
        return static_cast<std::uint32_t>(std::clamp(rows, 1.0, double{kMostSampleRows}));
    }

private:
    std::uint32_t piece_of(std::uint32_t triangle) const
    {
        return piece_at_[geometry_.welded[geometry_.triangles[triangle].x]];
    }

    const Geometry& geometry_;
    std::vector<std::uint32_t> piece_at_;  ///< by place
    double per_area_ = 0.0;
    std::vector<double> per_area_of_;  ///< by piece
};

/// In small triangles of a triangle cut into rows^2, near their middles: calls put(at).
template <class Put>
void for_each_place(std::uint32_t rows, const Put& put)
{
    const float size = 1.0f / static_cast<float>(rows);
    const glm::vec2 shift(kSampleShift[0], kSampleShift[1]);
    const glm::vec2 upright = glm::vec2(1.0f / 3.0f) + shift;
    const glm::vec2 turned = glm::vec2(2.0f / 3.0f) - shift;
    for (std::uint32_t i = 0; i < rows; ++i) {
        for (std::uint32_t j = 0; i + j < rows; ++j) {
            const glm::vec2 corner(static_cast<float>(i), static_cast<float>(j));
            put(size * (corner + upright));
            if (i + j + 1 < rows)
                put(size * (corner + turned));
        }
    }
}

}  // namespace

void add_triangles(std::span<const double> areas, SurfaceSamples& samples)
{
    constexpr std::size_t kBlock = 4096;
    const std::vector<std::uint8_t>& rows = samples.rows;
    struct Start {
        std::size_t cell, sample;
    };
    const auto for_each_block = [&](const auto& body) {
        for_tasks((rows.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
            body(b, b * kBlock, std::min(rows.size(), (b + 1) * kBlock));
        });
    };
    std::vector<Start> starts(rows.size() / kBlock + 2, {0, 0});
    for_each_block([&](std::size_t b, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            starts[b + 1].cell += rows[t] > 0 ? 1 : 0;
            starts[b + 1].sample += std::size_t{rows[t]} * rows[t];
        }
    });
    starts[0] = {samples.first_sample.size(), samples.points.size()};
    for (std::size_t b = 1; b < starts.size(); ++b)
        starts[b] = {starts[b - 1].cell + starts[b].cell, starts[b - 1].sample + starts[b].sample};
    samples.first_sample.resize(starts.back().cell + 1);
    samples.first_sample.back() = static_cast<std::uint32_t>(starts.back().sample);
    samples.points.resize(starts.back().sample);
    samples.areas.resize(starts.back().sample);
    for_each_block([&](std::size_t b, std::size_t begin, std::size_t end) {
        Start at = starts[b];
        for (std::size_t t = begin; t < end; ++t) {
            if (rows[t] == 0)
                continue;
            samples.first_sample[at.cell++] = static_cast<std::uint32_t>(at.sample);
            for_each_place(rows[t], [&](glm::vec2 place) {
                samples.points[at.sample] = {static_cast<std::uint32_t>(t), place};
                samples.areas[at.sample++] =
                    static_cast<float>(areas[t] / (std::uint32_t{rows[t]} * rows[t]));
            });
        }
    });
}

void drop_triangles(SurfaceSamples& samples, std::size_t first, std::size_t end)
{
    const auto cut = [](auto& list, std::size_t count) {
        list.resize(count);
        list.shrink_to_fit();
    };
    const std::size_t in_quads = samples.quad_weights.size();
    cut(samples.areas, in_quads);
    cut(samples.first_sample, samples.quads.size());
    const std::size_t begin = std::max(first, in_quads);
    if (end == samples.points.size())
        cut(samples.points, in_quads);
    else if (begin < end)
        discard(std::span(samples.points).subspan(begin, end - begin));
}

SurfaceSamples samples_of(const Geometry& geometry, std::span<const std::uint32_t> unknowns)
{
    const auto count = static_cast<std::uint32_t>(geometry.triangles.size());
    const std::vector<double> areas = triangle_areas(geometry);
    const Density density(geometry, areas);
    SurfaceSamples samples;
    std::vector<std::uint8_t>& rows = samples.rows;
    rows.resize(count);
    for_all(count, [&](std::size_t t) {
        rows[t] =
            static_cast<std::uint8_t>(density.rows_of(static_cast<std::uint32_t>(t), areas[t]));
    });

    std::vector<std::uint32_t> among;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (count <= kQuadsEverywhere || rows[t] > 1)
            among.push_back(t);
    }
    std::vector<Quad> quads;
    if (!among.empty())
        quads = QuadFinder(geometry, unknowns, among).quads;
    samples.first_sample.reserve(count - quads.size() + 1);
    Sampler sampler(samples);
    for (const Quad& quad : quads) {
        const double area = areas[quad.triangles[0]] + areas[quad.triangles[1]];
        sampler.add_quad(quad, density.rows_of(quad.triangles[0], area), area);
        rows[quad.triangles[0]] = rows[quad.triangles[1]] = 0;
    }
    add_triangles(areas, samples);
    return samples;
}

}  // namespace surfelao
