/// flight.h: a camera that a user flies through a room.
#pragma once

#include "pixels/camera.h"

#include <glm/vec3.hpp>

#include <string_view>

namespace surfelao {

/// Diagonals a second.
inline constexpr float kLeastFlightSpeed = 0.005f, kMostFlightSpeed = 5.0f;

struct Flight {
    bool is_on = false;
    float speed = 0.2f;  ///< kLeastFlightSpeed to kMostFlightSpeed
};

/// The keys of flight.
inline constexpr std::string_view kFlightKeys = "WASDEQ";

/// Turns the view about the eye: to the right, and upwards short of the poles.
void look_around(Camera& camera, float right_deg, float up_deg);

/// Where the keys that are held lead in that time: to the right, upwards and forward. Two keys at
/// once are no faster than one.
[[nodiscard]] glm::vec3 flight_step(std::string_view held, float speed, double seconds);

/// Moves eye and target: right and forward as the camera looks, upwards along its up.
void fly(Camera& camera, glm::vec3 step);

}  // namespace surfelao
