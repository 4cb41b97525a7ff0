#include "bake/fit_cells.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <unordered_map>
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
    QuadFinder(const Geometry& geometry, std::span<const std::uint32_t> unknowns,
               const std::vector<std::uint32_t>& large)
        : geometry_(geometry), unknowns_(unknowns)
    {
        for (const std::uint32_t t : large) {
            for (int side = 0; side < 3; ++side) {
                const auto [entry, is_new] =
                    sides_.try_emplace(key(unknown(t, side), unknown(t, side + 1)),
                                       3 * t + static_cast<unsigned>(side));
                if (!is_new)
                    entry->second = kNone;  // three or more triangles meet: no quad
            }
        }
        std::unordered_map<std::uint32_t, std::uint32_t> best;  // triangle -> neighbour
        for (const std::uint32_t t : large)
            best[t] = best_neighbour(t);
        for (const std::uint32_t t : large) {
            const std::uint32_t other = best[t];
            if (other != kNone && t < other && best[other] == t)
                quads.push_back(*quad_at(t, other));
        }
    }

    std::vector<Quad> quads;  ///< by rising first triangle

private:
    static std::uint64_t key(std::uint32_t from, std::uint32_t to)
    {
        return std::uint64_t{from} << 32 | to;
    }
    std::uint32_t unknown(std::uint32_t triangle, int corner) const
    {
        return unknowns_[geometry_.triangles[triangle][corner % 3]];
    }
    glm::dvec3 place(std::uint32_t triangle, int corner) const
    {
        return geometry_.positions[geometry_.triangles[triangle][corner % 3]];
    }

    /// The triangle on the other side of a side, and its side; kNone where there is none.
    std::uint32_t across(std::uint32_t triangle, int side) const
    {
        const auto own = sides_.find(key(unknown(triangle, side), unknown(triangle, side + 1)));
        const auto found = sides_.find(key(unknown(triangle, side + 1), unknown(triangle, side)));
        return found == sides_.end() || own->second == kNone ? kNone : found->second;
    }

    /// Of t and the triangle beyond its side; empty where they make none.
    std::optional<Quad> quad_over(std::uint32_t t, int side) const
    {
        const std::uint32_t found = across(t, side);
        if (found == kNone || found / 3 == t)
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

    std::optional<Quad> quad_at(std::uint32_t t, std::uint32_t other) const
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
    std::unordered_map<std::uint64_t, std::uint32_t> sides_;  ///< 3 triangle + side
};

class Sampler {
public:
    Sampler(const Geometry& geometry, SurfaceSamples& samples)
        : geometry_(geometry), samples_(samples)
    {
    }

    void add_triangle(std::uint32_t triangle, glm::uvec3 unknowns, std::uint32_t rows, double area)
    {
        begin(glm::uvec4(unknowns, FitCell::kNoCorner));
        const float size = 1.0f / static_cast<float>(rows);
        const glm::vec2 shift(kSampleShift[0], kSampleShift[1]);
        const glm::vec2 upright = glm::vec2(1.0f / 3.0f) + shift;
        const glm::vec2 turned = glm::vec2(2.0f / 3.0f) - shift;
        const auto share = static_cast<float>(area / (rows * rows));
        const auto put = [&](glm::vec2 at) {
            samples_.points.push_back({triangle, size * at});
            samples_.areas.push_back(share);
        };
        for (std::uint32_t i = 0; i < rows; ++i) {
            for (std::uint32_t j = 0; i + j < rows; ++j) {
                const glm::vec2 corner(static_cast<float>(i), static_cast<float>(j));
                put(corner + upright);
                if (i + j + 1 < rows)
                    put(corner + turned);
            }
        }
    }

    void add_quad(const Quad& quad, std::uint32_t rows, double area)
    {
        begin(quad.unknowns);
        const auto& [a, b, c, d] = quad.places;
        const std::size_t first = samples_.areas.size();
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

    void begin(glm::uvec4 unknowns)
    {
        samples_.cells.push_back({unknowns, static_cast<std::uint32_t>(samples_.points.size())});
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

    const Geometry& geometry_;
    SurfaceSamples& samples_;
};

}  // namespace

double area_of(const Geometry& geometry, std::size_t triangle)
{
    const glm::uvec3 t = geometry.triangles[triangle];
    const glm::dvec3 a(geometry.positions[t.x]);
    return 0.5 * glm::length(glm::cross(glm::dvec3(geometry.positions[t.y]) - a,
                                        glm::dvec3(geometry.positions[t.z]) - a));
}

SurfaceSamples samples_of(const Geometry& geometry, std::span<const std::uint32_t> unknowns)
{
    const std::size_t count = geometry.triangles.size();
    std::vector<double> areas(count);
    double whole = 0.0;
    for (std::size_t t = 0; t < count; ++t)
        whole += areas[t] = area_of(geometry, t);
    const auto wanted = static_cast<double>(std::max<std::uint64_t>(
        std::min<std::uint64_t>(kFewestSamples, kMostSamplesEach * count), count));
    const auto rows_of = [&](double area) {
        const double rows = std::round(std::sqrt(wanted * area / whole));
        return static_cast<std::uint32_t>(std::clamp(rows, 1.0, double{kMostSampleRows}));
    };

    std::vector<std::uint32_t> large;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (rows_of(areas[t]) > 1)
            large.push_back(t);
    }
    const std::vector<Quad> quads = QuadFinder(geometry, unknowns, large).quads;
    SurfaceSamples samples;
    samples.cells.reserve(count - quads.size() + 1);
    samples.points.reserve(count + static_cast<std::size_t>(wanted) / 4);
    samples.areas.reserve(samples.points.capacity());
    Sampler sampler(geometry, samples);
    std::vector<bool> done(count, false);
    for (const Quad& quad : quads) {
        const double area = areas[quad.triangles[0]] + areas[quad.triangles[1]];
        sampler.add_quad(quad, rows_of(area), area);
        done[quad.triangles[0]] = done[quad.triangles[1]] = true;
    }
    for (std::uint32_t t = 0; t < count; ++t) {
        if (done[t])
            continue;
        const glm::uvec3 corners = geometry.triangles[t];
        sampler.add_triangle(t, {unknowns[corners.x], unknowns[corners.y], unknowns[corners.z]},
                             rows_of(areas[t]), areas[t]);
    }
    sampler.begin(glm::uvec4(FitCell::kNoCorner));
    return samples;
}

}  // namespace surfelao
