/// smoothing.h: few rays made smooth: the hardest opponent on dense smooth meshes.
///
/// Noise of neighbouring vertices is independent (every receiver has its own scramble), so a mean
/// over the one-ring takes much of it away. It also blurs real edges: it stalls at an RMSE of 0.01
/// to 0.03 and ruins meshes whose neighbours see different things.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"

#include <span>
#include <vector>

namespace surfelao {

/// One normal-weighted one-ring step over the mesh: weight 2 for the vertex itself, and for each
/// neighbour max(0, cosine of the angle between the normals)^8. Welded vertices are one vertex.
/// occlusion: one per scene vertex, SettingsError if not. Vertices without a normal keep their
/// value. O(n), all cores, same bytes for any number of threads.
[[nodiscard]] std::vector<Occlusion> smooth_occlusion(const Geometry& geometry,
                                                      std::span<const Occlusion> occlusion);

}  // namespace surfelao
