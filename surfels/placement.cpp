#include "surfels/placement.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace surfelao {

glm::dmat4 matrix_of(const Placement& placement)
{
    glm::dmat4 matrix(placement.scale * placement.rotation);
    matrix[3] = glm::dvec4(placement.translation, 1.0);
    return matrix;
}

Placement inverse(const Placement& placement)
{
    const glm::dmat3 back = glm::transpose(placement.rotation);
    const double scale = 1.0 / placement.scale;
    return {back, scale, -scale * (back * placement.translation)};
}

Placement operator*(const Placement& after, const Placement& before)
{
    return {after.rotation * before.rotation, after.scale * before.scale,
            placed_point(before.translation, after)};
}

std::optional<Placement> placement_of(const glm::dmat4& matrix)
{
    constexpr double kEven = 1e-6;
    const glm::dmat3 linear(matrix);
    const double scale = glm::length(linear[0]);
    if (!(scale > 0.0) || !std::isfinite(scale))
        return std::nullopt;
    Placement placement;
    placement.scale = scale;
    placement.rotation = linear / scale;
    placement.translation = glm::dvec3(matrix[3]);
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(placement.translation[i]))
            return std::nullopt;
        for (int j = 0; j < 3; ++j) {
            const double product = glm::dot(placement.rotation[i], placement.rotation[j]);
            if (!(std::abs(product - (i == j ? 1.0 : 0.0)) <= kEven))
                return std::nullopt;
        }
    }
    return placement;
}

glm::dvec3 placed_point(const glm::dvec3& point, const Placement& placement)
{
    return placement.scale * (placement.rotation * point) + placement.translation;
}

Receiver placed(const Receiver& receiver, const Placement& placement)
{
    if (placement == Placement{})
        return receiver;
    const glm::dvec3 normal = placement.rotation * glm::dvec3(receiver.normal);
    const double length = glm::length(normal);
    return {glm::vec3(placed_point(receiver.position, placement)),
            length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f),
            static_cast<float>(placement.scale * receiver.offset)};
}

}  // namespace surfelao
