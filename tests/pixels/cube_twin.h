/// cube_twin.h: shaders/cube_project.frag again, plainly, with tests that can be loosened.
#pragma once

#include "pixels/cube_projector.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace surfelao {

struct TwinTests {
    float plane = 1.0f;         ///< footprints
    float reach = 3.0f;         ///< footprints over the cosine
    float least_normal = 0.8f;  ///< cosine
    float least_cosine = 0.0f;  ///< of the point's normal and the way to the centre
};

/// Occlusion and its share in what is shown; 0 where no map answers.
struct TwinAnswer {
    float occlusion = 0.0f, share = 0.0f;
};

/// What one map's texels round the point tell: sums of occlusion and weights.
inline glm::vec2 twin_texels(const CubeMap& map, glm::vec3 point, glm::vec3 normal, float cosine,
                             const TwinTests& tests)
{
    const glm::vec3 d = point - map.centre;
    int face = 0;
    for (int other = 1; other < kCubeFaces; ++other) {
        const glm::vec3 best = face_view(map.centre, face).forward;
        if (glm::dot(face_view(map.centre, other).forward, d) > glm::dot(best, d))
            face = other;
    }
    const View view = face_view(map.centre, face);
    const glm::vec3 seen = to_view(view, point);
    const glm::vec2 place =
        (0.5f + 0.5f * glm::vec2(seen) / seen.z) * static_cast<float>(map.size) - 0.5f;
    const float footprint = 2.0f * glm::length(d) / static_cast<float>(map.size);
    glm::vec2 sums(0.0f);
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 corner(k % 2, k / 2);
        const glm::ivec2 low(glm::floor(place));
        const glm::ivec2 texel = glm::clamp(low + corner, 0, map.size - 1);
        const auto index =
            static_cast<std::size_t>(texel.x + map.size * (texel.y + map.size * face));
        if (map.distances[index] >= kNothingThere)
            continue;
        const PixelRay ray =
            pixel_ray(view.lens, map.size, map.size, glm::vec2(texel) + glm::vec2(0.5f));
        const glm::vec3 q =
            to_world(view, map.distances[index] * glm::normalize(ray.direction)) - point;
        if (std::abs(glm::dot(q, normal)) > tests.plane * footprint ||
            glm::length(q) > tests.reach * footprint / std::abs(cosine) ||
            glm::dot(direction_of(map.normals[index]), normal) < tests.least_normal)
            continue;
        const glm::vec2 far = glm::abs(place - glm::vec2(low + 1 - corner));
        sums += far.x * far.y * glm::vec2(static_cast<float>(map.occlusion[index]) / 255.0f, 1.0f);
    }
    return sums;
}

inline TwinAnswer twin_answer(std::span<const CubeMap> maps, std::span<const ProjectedMap> used,
                              glm::vec3 point, glm::vec3 normal, const TwinTests& tests = {})
{
    double sum = 0.0, qualities = 0.0, shown = 0.0, weight = 0.0;
    float share = 0.0f;
    for (std::size_t k = 0; k < used.size(); ++k) {
        const glm::vec3 d = point - maps[used[k].index].centre;
        const float distance = glm::length(d);
        const float cosine = -glm::dot(normal, d) / distance;
        if (cosine > tests.least_cosine) {
            const glm::vec2 read = twin_texels(maps[used[k].index], point, normal, cosine, tests);
            const glm::vec3 size = glm::abs(d);
            const double quality =
                std::pow(cosine * std::max({size.x, size.y, size.z}) / (distance * distance), 4.0);
            sum += read.y < 0.02f ? 0.0 : quality * read.x / read.y;
            qualities += read.y < 0.02f ? 0.0 : quality;
        }
        const float next = k + 1 < used.size() ? used[k + 1].weight : 0.0f;
        if (qualities > 0.0) {
            shown += (used[k].weight - next) * sum / qualities;
            weight += used[k].weight - next;
            share = std::max(share, used[k].weight);
        }
    }
    if (weight == 0.0)
        return {};
    return {static_cast<float>(shown / weight), std::min(1.0f, share / 0.5f)};
}

}  // namespace surfelao
