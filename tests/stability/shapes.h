/// shapes.h: the bricks of the hard cases. Each adds its triangles to a scene; faces look outwards
/// or along u x v.
#pragma once

#include "surfels/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>

namespace surfelao::stability {

/// cells_u x cells_v squares of two triangles each over point(u, v), u and v in [0, 1].
/// Returns the first new vertex; they stand row by row, (cells_u + 1) a row.
std::uint32_t add_grid(Scene& scene, int cells_u, int cells_v,
                       const std::function<glm::dvec3(double u, double v)>& point);

/// The parallelogram corner, corner + u, corner + u + v, corner + v, cells x cells squares.
std::uint32_t add_sheet(Scene& scene, glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v, int cells);

/// Closed cuboid; the faces have vertices of their own, at exactly equal positions on the edges.
void add_box(Scene& scene, glm::dvec3 low, glm::dvec3 high, int cells);

/// Latitude-longitude sphere of 2 * cells x cells squares, closed, poles shared.
void add_sphere(Scene& scene, glm::dvec3 centre, double radius, int cells);

/// A flat triangle with vertices of its own.
void add_triangle(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);

/// Turns all triangles from `first` on the other way round.
void flip(Scene& scene, std::size_t first = 0);

/// Every position through a function.
void map(Scene& scene, const std::function<glm::dvec3(glm::dvec3)>& to);

/// A rotation about no special axis.
[[nodiscard]] glm::dmat3 odd_rotation();

/// Small generator, the same numbers everywhere (SplitMix64).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits();
    double share();          ///< uniform in [0, 1)
    glm::dvec3 in_cube();    ///< uniform in [0, 1)^3
    glm::dvec3 direction();  ///< uniform on the sphere

private:
    std::uint64_t state_;
};

}  // namespace surfelao::stability
