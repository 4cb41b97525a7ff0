#include "pixels/placed_grid.h"

#include "grid/cone.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace surfelao {
namespace {

/// Share of the sphere that the cap of a cone has.
double cap_share(const Cone& cone)
{
    return 0.5 * (1.0 - static_cast<double>(cone.cos_half));
}

/// What is read of the object, with its border, in its own directions; place: likewise.
Harmonics values_at(const PlacedGrid& object, glm::dvec3 place)
{
    Harmonics values{};
    read_values_in_border(*object.grid, place, values.data());
    return values;
}

glm::vec4 moments_in_world(const PlacedGrid& object, const Harmonics& values)
{
    const glm::vec4 own = moments_of(object.grid->store, values.data());
    return {glm::vec3(object.placement.rotation * glm::dvec3(own)), own.w};
}

glm::vec3 normal_in_object(const PlacedGrid& object, glm::vec3 normal)
{
    return glm::vec3(glm::dvec3(normal) * object.placement.rotation);
}

/// Of a receiver, lifted.
glm::dvec3 lifted_in_object(const PlacedGrid& object, glm::vec3 position, glm::vec3 normal)
{
    return in_object(object, position) + object.lift * glm::dvec3(normal_in_object(object, normal));
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
    return moments_in_world(object, values_at(object, in_object(object, position)));
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
    return occlusion_at(*object.grid, lifted_in_object(object, position, normal),
                        normal_in_object(object, normal));
}

std::vector<TakenLight> taken_at(std::span<const PlacedGrid> objects, GridMerge merge,
                                 glm::vec3 position, glm::vec3 normal, std::uint32_t surface)
{
    std::vector<TakenLight> all;
    glm::vec4 joined(0.0f);
    for (const PlacedGrid& object : objects) {
        if (surface != 0 && object.surface == surface)
            continue;
        const Harmonics values = values_at(object, lifted_in_object(object, position, normal));
        const glm::vec4 moments = moments_in_world(object, values);
        if (moments.w < kNothingHidden)
            continue;
        if (merge == GridMerge::caps)
            joined = merged(joined, moments);
        else
            all.push_back(
                {occlusion_of(object.grid->store, values.data(), normal_in_object(object, normal)),
                 moments});
    }
    if (joined.w >= kNothingHidden)
        all.push_back({occlusion_by(cone_of(joined), normal), joined});
    return all;
}

float visibility_at(std::span<const PlacedGrid> objects, GridMerge merge, glm::vec3 position,
                    glm::vec3 normal, std::uint32_t surface)
{
    float visibility = 1.0f;
    for (const TakenLight& taken : taken_at(objects, merge, position, normal, surface))
        visibility *= 1.0f - taken.occlusion;
    return visibility;
}

}  // namespace surfelao
