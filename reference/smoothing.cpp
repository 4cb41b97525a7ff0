#include "reference/smoothing.h"

#include "surfels/edges.h"
#include "surfels/errors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <string>

namespace surfelao {

std::vector<Occlusion> smooth_occlusion(const Geometry& geometry,
                                        std::span<const Occlusion> occlusion)
{
    require(occlusion.size() == geometry.positions.size(),
            "smoothing takes one answer per vertex: there are " +
                std::to_string(geometry.positions.size()) + " vertices and " +
                std::to_string(occlusion.size()) + " answers");
    // a neighbour is met twice where two triangles share the edge: all inner edges count alike, and
    // borders half as much
    const Buckets<std::uint32_t> corners = corners_around(geometry.triangles, geometry.welded);
    std::vector<Occlusion> result(occlusion.begin(), occlusion.end());
    const tbb::blocked_range<std::size_t> all(0, result.size(), 1024);
    tbb::parallel_for(all, [&](const auto& range) {
        for (std::size_t v = range.begin(); v < range.end(); ++v) {
            const glm::vec3 normal = geometry.normals[v];
            if (normal == glm::vec3(0.0f))
                continue;
            // every neighbour is met about twice, so the vertex counts four times for a weight
            // of 2
            float weight_sum = 4.0f;
            float sum = 4.0f * occlusion[v].occlusion;
            glm::vec3 bent = 4.0f * occlusion[v].bent_normal;
            const auto add = [&](std::uint32_t neighbour) {
                const float cosine = std::max(0.0f, glm::dot(normal, geometry.normals[neighbour]));
                const float cosine2 = cosine * cosine, cosine4 = cosine2 * cosine2;
                const float weight = cosine4 * cosine4;
                weight_sum += weight;
                sum += weight * occlusion[neighbour].occlusion;
                bent += weight * occlusion[neighbour].bent_normal;
            };
            for (const std::uint32_t corner : corners[geometry.welded[v]]) {
                const glm::uvec3 triangle = geometry.triangles[corner / 3];
                add(geometry.welded[triangle[static_cast<int>((corner + 1) % 3)]]);
                add(geometry.welded[triangle[static_cast<int>((corner + 2) % 3)]]);
            }
            const float length = glm::length(bent);
            result[v].occlusion = std::min(1.0f, sum / weight_sum);
            result[v].bent_normal = length > 0.0f ? bent / length : normal;
        }
    });
    return result;
}

}  // namespace surfelao
