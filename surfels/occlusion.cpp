#include "surfels/occlusion.h"

#include "surfels/errors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {

void check_definition(const Definition& definition)
{
    require(definition.max_distance > 0.0f, "max_distance must be above 0");
    require(definition.falloff == Falloff::none || std::isfinite(definition.max_distance),
            "a falloff needs a max_distance");
    if (!definition.ground)
        return;
    constexpr float kUnit = 1e-4f;  // a direction of floats, normalised, is off by 1e-7
    const glm::vec3 up = definition.ground->up;
    require(std::abs(glm::dot(up, up) - 1.0f) <= kUnit, "up of the ground must be of length 1");
    require(std::isfinite(definition.ground->height), "height of the ground must be finite");
    require(definition.kernel == Kernel::cosine, "a ground is for the cosine kernel only");
}

float hit_weight(const Definition& definition, float t)
{
    if (!(t < definition.max_distance))
        return 0.0f;
    if (definition.falloff == Falloff::none)
        return 1.0f;
    const float x = t / definition.max_distance;
    const float y = 1.0f - x * x;
    return y * y;
}

glm::vec3 bent_normal_of(glm::vec3 open, glm::vec3 normal)
{
    constexpr float kNothingLeft = 0.01f;  // of its length: the rest is mostly rounding
    const float length = glm::length(open);
    open -= std::min(0.0f, glm::dot(open, normal)) * normal;
    const float left = glm::length(open);
    return left > kNothingLeft * length ? open / left : normal;
}

}  // namespace surfelao
