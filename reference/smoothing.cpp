#include "reference/smoothing.h"

#include "surfels/errors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <string>

namespace surfelao {
namespace {

/// The one-ring of every position as one array with offsets. A neighbour stands twice in it where
/// two triangles share the edge: all inner edges count alike, and borders half as much.
struct OneRings {
    std::vector<std::uint32_t> first;  ///< into neighbours; one more than positions
    std::vector<std::uint32_t> neighbours;
};

OneRings one_rings(const Geometry& geometry)
{
    OneRings rings;
    rings.first.assign(geometry.positions.size() + 1, 0);
    for (const glm::uvec3 triangle : geometry.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            rings.first[geometry.welded[triangle[corner]] + 1] += 2;
    }
    std::partial_sum(rings.first.begin(), rings.first.end(), rings.first.begin());
    rings.neighbours.resize(rings.first.back());
    std::vector<std::uint32_t> next(rings.first.begin(), rings.first.end() - 1);
    for (const glm::uvec3 triangle : geometry.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t& place = next[geometry.welded[triangle[corner]]];
            rings.neighbours[place++] = geometry.welded[triangle[(corner + 1) % 3]];
            rings.neighbours[place++] = geometry.welded[triangle[(corner + 2) % 3]];
        }
    }
    return rings;
}

}  // namespace

std::vector<Occlusion> smooth_occlusion(const Geometry& geometry,
                                        std::span<const Occlusion> occlusion)
{
    require(occlusion.size() == geometry.positions.size(),
            "smoothing takes one answer per vertex: there are " +
                std::to_string(geometry.positions.size()) + " vertices and " +
                std::to_string(occlusion.size()) + " answers");
    const OneRings rings = one_rings(geometry);
    std::vector<Occlusion> result(occlusion.begin(), occlusion.end());
    const tbb::blocked_range<std::size_t> all(0, result.size(), 1024);
    tbb::parallel_for(all, [&](const auto& range) {
        for (std::size_t v = range.begin(); v < range.end(); ++v) {
            const glm::vec3 normal = geometry.normals[v];
            if (normal == glm::vec3(0.0f))
                continue;
            // every neighbour is listed about twice, so the vertex counts four times for a weight
            // of 2
            float weight_sum = 4.0f;
            float sum = 4.0f * occlusion[v].occlusion;
            glm::vec3 bent = 4.0f * occlusion[v].bent_normal;
            const std::uint32_t position = geometry.welded[v];
            for (std::uint32_t i = rings.first[position]; i < rings.first[position + 1]; ++i) {
                const std::uint32_t neighbour = rings.neighbours[i];
                const float cosine = std::max(0.0f, glm::dot(normal, geometry.normals[neighbour]));
                const float cosine2 = cosine * cosine, cosine4 = cosine2 * cosine2;
                const float weight = cosine4 * cosine4;
                weight_sum += weight;
                sum += weight * occlusion[neighbour].occlusion;
                bent += weight * occlusion[neighbour].bent_normal;
            }
            const float length = glm::length(bent);
            result[v].occlusion = std::min(1.0f, sum / weight_sum);
            result[v].bent_normal = length > 0.0f ? bent / length : normal;
        }
    });
    return result;
}

}  // namespace surfelao
