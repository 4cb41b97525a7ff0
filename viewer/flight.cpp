#include "viewer/flight.h"

#include <glm/geometric.hpp>

#include <utility>

namespace surfelao {

void look_around(Camera& camera, float right_deg, float up_deg)
{
    // what orbits about the eye is the target
    std::swap(camera.eye, camera.target);
    orbit(camera, -right_deg, up_deg);
    std::swap(camera.eye, camera.target);
}

glm::vec3 flight_step(std::string_view held, float speed, double seconds)
{
    const auto between = [&](char back, char forth) {
        const auto is_held = [&](char key) {
            return held.find(key) != std::string_view::npos ? 1.0f : 0.0f;
        };
        return is_held(forth) - is_held(back);
    };
    const glm::vec3 way(between('A', 'D'), between('Q', 'E'), between('S', 'W'));
    if (way == glm::vec3(0.0f))
        return way;
    return speed * static_cast<float>(seconds) * glm::normalize(way);
}

void fly(Camera& camera, glm::vec3 step)
{
    const CameraAxes axes = camera_axes(camera);
    const glm::vec3 by = step.x * axes.right + step.y * camera.up - step.z * axes.backwards;
    camera.eye += by;
    camera.target += by;
}

}  // namespace surfelao
