/// page_places.h: coordinates of the triangles that lie on one page. Internal to atlas/.
#pragma once

#include "surfels/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace surfelao {

/// Collects them from a set of the file, moved by one step.
class PagePlacesOf {
public:
    /// scene_triangles: how many there are in all.
    explicit PagePlacesOf(std::size_t scene_triangles)
    {
        uvs_.corners.assign(scene_triangles, kNowhere);
    }

    void add(std::size_t triangle, glm::uvec3 corners, const UvSet& from, glm::dvec2 step)
    {
        for (int k = 0; k < 3; ++k) {
            const auto [found, is_new] =
                moved_.try_emplace(corners[k], static_cast<std::uint32_t>(uvs_.values.size()));
            if (is_new)
                uvs_.values.push_back(from.values[corners[k]] + step);
            uvs_.corners[triangle][k] = found->second;
        }
    }

    [[nodiscard]] UvSet take() { return std::move(uvs_); }

private:
    static constexpr glm::uvec3 kNowhere{UvSet::kNone};

    UvSet uvs_;
    std::unordered_map<std::uint32_t, std::uint32_t> moved_;  // from the file's values to ours
};

/// Of a triangle in the set; kNone at any corner: it has no place.
[[nodiscard]] inline glm::uvec3 corners_in(const Scene& scene, const UvSet& uvs,
                                           std::size_t triangle)
{
    return uvs.corners.empty() ? scene.triangles[triangle] : uvs.corners[triangle];
}

}  // namespace surfelao
