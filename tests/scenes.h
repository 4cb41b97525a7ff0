/// scenes.h: worlds made in code, for tests and benchmarks of every folder.
///
/// All shapes face outward (counterclockwise seen from where one looks at them), share vertices
/// inside a patch, and are the same bytes on every machine.
#pragma once

#include "surfels/scene.h"

#include <glm/vec3.hpp>

#include <functional>

namespace surfelao::scenes {

/// cells_u * cells_v quads over point(s, t), s and t in [0, 1]; vertices row by row along s. Faces
/// along du x dv.
[[nodiscard]] Scene grid(int cells_u, int cells_v,
                         const std::function<glm::dvec3(double s, double t)>& point);

/// One triangle.
[[nodiscard]] Scene triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);

/// A grid of cells * cells quads over corner + s u + t v, s and t in [0, 1]; faces along u x v.
[[nodiscard]] Scene sheet(glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v, int cells);

/// A grid over the unit square; `height` gives z at (x, y). Faces up.
[[nodiscard]] Scene height_field(int cells, const std::function<double(double, double)>& height);

/// The surface of the box, cells * cells quads a side. Edges and corners of the box are shared.
[[nodiscard]] Scene box(glm::dvec3 low, glm::dvec3 high, int cells);

/// A cube of cells * cells quads a side, blown up to the sphere: 6 cells^2 + 2 vertices.
[[nodiscard]] Scene sphere(glm::dvec3 centre, double radius, int cells);

/// The same, with four octaves of bumps of a fifth of the radius: what dense scans look like to an
/// occlusion engine. Mean occlusion about 0.3.
[[nodiscard]] Scene bumpy_sphere(int cells);

/// Spheres of radius 1, 1 - gap, ... about one centre.
[[nodiscard]] Scene nested_shells(int count, double gap, int cells);

/// An endless corner, nearly: floor z = 0 and wall x = 0, both `size` wide, meeting along the y
/// axis. One connected sheet, facing the free quarter.
[[nodiscard]] Scene wall_and_floor(double size, int cells);

/// A box that faces inward.
[[nodiscard]] Scene room(glm::dvec3 low, glm::dvec3 high, int cells);

/// Appends b to a.
[[nodiscard]] Scene operator+(Scene a, const Scene& b);
Scene& operator+=(Scene& a, const Scene& b);

/// Every vertex through `place`.
[[nodiscard]] Scene moved(Scene scene, const std::function<glm::dvec3(glm::dvec3)>& place);

/// Every triangle turned round.
[[nodiscard]] Scene flipped(Scene scene);

}  // namespace surfelao::scenes
