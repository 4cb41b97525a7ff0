#include "pixels/placed_grid.h"

#include "grid/cone.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace surfelao {
namespace {

constexpr float kNothingHidden = 1e-7f;

/// Share of the sphere that the cap of a cone has.
double cap_share(const Cone& cone)
{
    return 0.5 * (1.0 - static_cast<double>(cone.cos_half));
}

}  // namespace

std::string name_of(GridMerge merge)
{
    return merge == GridMerge::product ? "product" : "union";
}

std::optional<GridMerge> grid_merge_of(std::string_view name)
{
    for (const GridMerge merge : {GridMerge::product, GridMerge::caps}) {
        if (name == name_of(merge))
            return merge;
    }
    return {};
}

glm::dvec3 in_object(const PlacedGrid& object, glm::vec3 position)
{
    const Placement& at = object.placement;
    return (glm::dvec3(position) - at.translation) * at.rotation / at.scale;
}

glm::vec4 moments_at(const PlacedGrid& object, glm::vec3 position)
{
    const glm::dvec3 place = in_object(object, position);
    float values[channels_of(GridStore::sh)];
    read_values(*object.grid, place, values);
    const glm::vec4 own = moments_of(object.grid->store, values);
    const glm::dvec3 turned = object.placement.rotation * glm::dvec3(own);
    return border_weight(*object.grid, place, own.w) * glm::vec4(glm::vec3(turned), own.w);
}

glm::vec4 merged(const glm::vec4& a, const glm::vec4& b)
{
    if (a.w < kNothingHidden)
        return b;
    if (b.w < kNothingHidden)
        return a;
    const Cone first = cone_of(a), second = cone_of(b);
    const double area_a = cap_share(first), area_b = cap_share(second);
    const double both =
        merged_caps(area_a, area_b, static_cast<double>(glm::dot(first.axis, second.axis)));
    const float shared = first.cover * second.cover * static_cast<float>(area_a + area_b - both);
    const auto of_a = static_cast<float>(area_b / (area_a + area_b));
    const glm::vec3 mean = glm::mix(glm::vec3(b) / b.w, glm::vec3(a) / a.w, of_a);
    return {glm::vec3(a) + glm::vec3(b) - shared * mean,
            std::clamp(a.w + b.w - shared, 0.0f, 1.0f)};
}

float occlusion_at(const PlacedGrid& object, glm::vec3 position, glm::vec3 normal)
{
    const glm::dvec3 turned = glm::dvec3(normal) * object.placement.rotation;
    return occlusion_at(*object.grid, in_object(object, position), glm::vec3(turned));
}

std::vector<TakenLight> taken_at(std::span<const PlacedGrid> objects, GridMerge merge,
                                 glm::vec3 position, glm::vec3 normal)
{
    std::vector<TakenLight> all;
    glm::vec4 joined(0.0f);
    for (const PlacedGrid& object : objects) {
        const glm::vec4 moments = moments_at(object, position);
        if (moments.w < kNothingHidden)
            continue;
        joined = merged(joined, moments);
        if (merge == GridMerge::product)
            all.push_back({occlusion_at(object, position, normal), moments});
    }
    if (merge == GridMerge::caps && joined.w >= kNothingHidden)
        all.push_back({occlusion_by(cone_of(joined), normal), joined});
    return all;
}

float visibility_at(std::span<const PlacedGrid> objects, GridMerge merge, glm::vec3 position,
                    glm::vec3 normal)
{
    float visibility = 1.0f;
    for (const TakenLight& taken : taken_at(objects, merge, position, normal))
        visibility *= 1.0f - taken.occlusion;
    return visibility;
}

}  // namespace surfelao
