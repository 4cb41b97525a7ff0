/// seen_of_wall.h: the exact answer at the foot of a wall.
#pragma once

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace surfelao {

/// The share of the hemisphere that a wall takes of what a square foot of floor sees from the
/// distance d: the wall is `height` high and ends `left` and `right` of the foot (Howell. A Catalog
/// of Radiation Heat Transfer Configuration Factors. B-4).
inline double seen_of_wall(double d, double height, double left, double right)
{
    const double far = std::hypot(d, height);
    double sum = 0.0;
    for (const double side : {left, right})
        sum += std::atan(side / d) - d / far * std::atan(side / far);
    return sum / (2.0 * glm::pi<double>());
}

}  // namespace surfelao
