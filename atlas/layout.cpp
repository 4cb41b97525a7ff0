#include "atlas/layout.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace surfelao {
namespace {

glm::vec3 normal_at(const Mesh& mesh, const SurfacePoint& point)
{
    const glm::uvec3 wedges = mesh.surface.corners(mesh.geometry)[point.triangle];
    const std::vector<glm::vec3>& normals = mesh.surface.normals;
    return (1.0f - point.at.x - point.at.y) * normals[wedges.x] + point.at.x * normals[wedges.y] +
           point.at.y * normals[wedges.z];
}

}  // namespace

glm::vec3 page_weights(glm::vec3 normal)
{
    const glm::vec3 squares = normal * normal / glm::dot(normal, normal);
    const glm::vec3 above = glm::max(squares - kLeastPageWeight, glm::vec3(0.0f));
    return above / (above.x + above.y + above.z);
}

PagePlaces places_of(const Mesh& mesh, const MapLayout& layout, const SurfacePoint& point)
{
    PagePlaces places;
    const glm::vec3 weights =
        layout.is_blended ? page_weights(normal_at(mesh, point)) : glm::vec3(1.0f);
    float sum = 0.0f;
    for (std::uint32_t page = 0; page < layout.pages.size(); ++page) {
        const auto uv = uv_at(mesh.geometry, layout.pages[page], point);
        if (!uv)
            continue;
        const float weight = layout.is_blended ? weights[static_cast<int>(page)] : 1.0f;
        places.list[places.count++] = {page, *uv, weight};
        sum += weight;
        if (!layout.is_blended)
            break;
    }
    for (std::size_t i = 0; i < places.count; ++i) {
        float& weight = places.list[i].weight;
        weight = sum > 0.0f ? weight / sum : 1.0f / static_cast<float>(places.count);
    }
    return places;
}

float fetch_at(std::span<const Map> pages, const PagePlaces& places, std::uint32_t channel)
{
    float sum = 0.0f;
    for (const PagePlace& place : places.places())
        sum += place.weight * fetch(pages[place.page], channel, place.uv);
    return sum;
}

}  // namespace surfelao
