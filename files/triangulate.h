/// triangulate.h: a polygon as triangles.
///
/// Based on:
///   Newell's normal, as in Sutherland, Sproull, Schumacker. A Characterization of Ten Hidden-
///     Surface Algorithms. ACM Computing Surveys 6(1), 1974
///   Meisters. Polygons Have Ears. American Mathematical Monthly 82, 1975
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Appends exactly n - 2 triangles over the n >= 3 corners (indices into positions, which must be
/// in range), wound like the polygon. Their numbers are places in `corners`: a corner may bring
/// more than its vertex.
///
/// Convex polygons become the fan of their first corner. Others are cut by their ears in the plane
/// of the Newell normal (projected along its largest axis, so that coordinates are not rounded
/// again); this is right for every simple polygon, also with collinear and repeated corners. A
/// polygon that crosses itself has no right answer: every corner is used and nothing more is
/// promised.
///
/// O(n) for convex polygons. Others take n log n as a rule and n^1.5 where walls are folded many
/// times (200,000 corners of a square spiral: some 1,100 tests each). No polygon gets more tests
/// than kMostEarTests a corner, nor, where it has very many corners, than kManyEarTests and
/// kFewEarTests a corner; what is left then, as most of a polygon that crosses itself all over,
/// becomes a fan. So no file costs more than a bounded time per corner.
void triangulate(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> corners,
                 std::vector<glm::uvec3>& triangles);

// A test is a reflex corner, or a box around some, against an ear: a few nanoseconds.
inline constexpr std::uint64_t kMostEarTests = 2048;
inline constexpr std::uint64_t kManyEarTests = 1u << 28;
inline constexpr std::uint64_t kFewEarTests = 64;

}  // namespace surfelao
