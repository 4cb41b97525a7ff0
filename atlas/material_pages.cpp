#include "atlas/material_pages.h"

#include "atlas/page_places.h"

#include <algorithm>
#include <map>

namespace surfelao {

MapLayout material_layout(const Scene& scene, const UvSet& uvs, const BaseColors& colors,
                          MapSize size)
{
    std::map<std::uint32_t, PagePlacesOf> pages;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::uvec3 corners = corners_in(scene, uvs, t);
        if (std::max({corners.x, corners.y, corners.z}) == UvSet::kNone)
            continue;
        pages.try_emplace(colors.triangles[t], scene.triangles.size())
            .first->second.add(t, corners, uvs, glm::dvec2(0.0));
    }
    MapLayout layout{.size = size, .pages = {}};
    for (auto& [material, page] : pages) {
        layout.pages.push_back(page.take());
        layout.materials.push_back(material);
    }
    return layout;
}

}  // namespace surfelao
