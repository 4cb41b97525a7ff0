#include "pixels/place.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace surfelao {

float footprint_at(const View& view, int height, glm::vec3 position)
{
    const float pixel = (view.lens.high.y - view.lens.low.y) / static_cast<float>(height);
    return view.lens.orthographic ? pixel : pixel * glm::dot(position - view.eye, view.forward);
}

float off_plane(const Place& place, const Place& other)
{
    return std::abs(glm::dot(place.position - other.position, other.normal));
}

bool are_like(const Place& place, const Place& other, float footprint)
{
    return place.part == other.part && off_plane(place, other) <= kLikePlane * footprint &&
           glm::dot(place.normal, other.normal) >= kLikeNormals;
}

}  // namespace surfelao
