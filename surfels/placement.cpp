#include "surfels/placement.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace surfelao {

glm::dmat4 matrix_of(const Placement& placement)
{
    glm::dmat4 matrix(placement.scale * placement.rotation);
    matrix[3] = glm::dvec4(placement.translation, 1.0);
    return matrix;
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

Receiver placed(const Receiver& receiver, const Placement& placement)
{
    const glm::dvec3 normal = placement.rotation * glm::dvec3(receiver.normal);
    const double length = glm::length(normal);
    return {glm::vec3(placement.scale * (placement.rotation * glm::dvec3(receiver.position)) +
                      placement.translation),
            length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f),
            static_cast<float>(placement.scale * receiver.offset)};
}

}  // namespace surfelao
