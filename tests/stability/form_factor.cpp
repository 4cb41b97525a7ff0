#include "tests/stability/form_factor.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace surfelao::stability {

double form_factor(const Receiver& receiver, const Polygon& polygon)
{
    const glm::dvec3 eye(receiver.position), n(receiver.normal);
    Polygon seen;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 a = polygon[i] - eye;
        const glm::dvec3 b = polygon[(i + 1) % polygon.size()] - eye;
        const double height_a = glm::dot(n, a), height_b = glm::dot(n, b);
        if (height_a >= 0.0)
            seen.push_back(a);
        if ((height_a < 0.0) != (height_b < 0.0))
            seen.push_back(a + height_a / (height_a - height_b) * (b - a));
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const glm::dvec3 a = seen[i], b = seen[(i + 1) % seen.size()];
        const glm::dvec3 across = glm::cross(a, b);
        const double sine = glm::length(across);
        if (sine > 0.0)  // corners in one direction span no angle
            sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(n, across) / sine;
    }
    return std::abs(sum) / (2.0 * std::numbers::pi);
}

double form_factor(const Receiver& receiver, std::span<const Polygon> polygons)
{
    double sum = 0.0;
    for (const Polygon& polygon : polygons)
        sum += form_factor(receiver, polygon);
    return sum;
}

double sphere_form_factor(const Receiver& receiver, glm::dvec3 centre, double radius)
{
    const glm::dvec3 to_centre = centre - glm::dvec3(receiver.position);
    const double distance = glm::length(to_centre);
    return radius * radius * glm::dot(glm::dvec3(receiver.normal), to_centre) /
           (distance * distance * distance);
}

}  // namespace surfelao::stability
