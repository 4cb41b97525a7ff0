#include "pixels/camera.h"

#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace surfelao {
namespace {

constexpr float kMargin = 0.9f;            // share of the picture that framed points may fill
constexpr float kMaxElevationDeg = 89.0f;  // where orbiting stops: at the pole `up` has no side
constexpr float kMinDistance = 1e-4f, kMaxDistance = 1e3f;

/// Any direction that is at right angles to the unit vector `up`, the same for the same up: what
/// azimuth 0 looks from.
glm::vec3 azimuth_zero(glm::vec3 up)
{
    return std::abs(up.z) > 0.5f ? glm::vec3(0.0f, -1.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f);
}

glm::vec3 towards_eye(glm::vec3 up, const ViewDirection& direction)
{
    const float azimuth = glm::radians(direction.azimuth_deg);
    const float elevation = glm::radians(direction.elevation_deg);
    const glm::vec3 front = azimuth_zero(up);
    const glm::vec3 side = glm::cross(up, front);
    return std::cos(elevation) * (std::cos(azimuth) * front + std::sin(azimuth) * side) +
           std::sin(elevation) * up;
}

ViewDirection direction_of(const Camera& camera)
{
    const glm::vec3 to_eye = glm::normalize(camera.eye - camera.target);
    const glm::vec3 front = azimuth_zero(camera.up);
    const glm::vec3 side = glm::cross(camera.up, front);
    return {glm::degrees(std::atan2(glm::dot(to_eye, side), glm::dot(to_eye, front))),
            glm::degrees(std::asin(glm::clamp(glm::dot(to_eye, camera.up), -1.0f, 1.0f)))};
}

}  // namespace

glm::vec3 up_direction(UpAxis up)
{
    return up == UpAxis::y ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f);
}

CameraAxes camera_axes(const Camera& camera)
{
    const glm::vec3 backwards = glm::normalize(camera.eye - camera.target);
    glm::vec3 right = glm::cross(camera.up, backwards);
    if (glm::dot(right, right) < 1e-12f)
        right = glm::cross(camera.up, azimuth_zero(camera.up));
    right = glm::normalize(right);
    return {right, glm::cross(backwards, right), backwards};
}

glm::mat4 view_matrix(const Camera& camera)
{
    const CameraAxes axes = camera_axes(camera);
    const glm::mat4 rotation = glm::transpose(
        glm::mat4(glm::vec4(axes.right, 0.0f), glm::vec4(axes.upwards, 0.0f),
                  glm::vec4(axes.backwards, 0.0f), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)));
    return glm::translate(rotation, -camera.eye);
}

glm::mat4 projection_matrix(const Camera& camera, float aspect, float near, float far,
                            glm::vec2 shift)
{
    glm::mat4 projection = glm::perspective(glm::radians(camera.fovy_deg), aspect, near, far);
    projection[2][0] -= shift.x;  // clip.w is -z: after the division this adds the shift
    projection[2][1] -= shift.y;
    return projection;
}

// In view coordinates about any centre, with z towards the eye, a point is inside the right edge of
// the picture when  x - cx <= tx (d - z),  and inside the left one when  cx - x <= tx (d - z):
//     cx + tx d >= max(x + tx z) = a        -cx + tx d >= max(-x + tx z) = b
// The nearest camera that satisfies both has  tx d = (a + b) / 2  and  cx = (a - b) / 2.
glm::vec2 sample_shift(int index)
{
    // 1 / g and 1 / g^2 with g^3 = g + 1
    const glm::dvec2 step(0.7548776662466927, 0.5698402909980532);
    const glm::dvec2 place = glm::fract(glm::dvec2(0.5) + step * static_cast<double>(index));
    return glm::vec2(place - 0.5);
}

Camera frame_points(std::span<const glm::vec3> points, UpAxis up, float aspect,
                    const ViewDirection& direction, float fovy_deg)
{
    Camera camera;
    camera.up = up_direction(up);
    camera.fovy_deg = fovy_deg;
    camera.target = glm::vec3(0.0f);
    camera.eye = towards_eye(camera.up, direction);
    const CameraAxes axes = camera_axes(camera);

    const float tan_y = kMargin * std::tan(0.5f * glm::radians(fovy_deg));
    const float tan_x = tan_y * aspect;
    constexpr float kLowest = std::numeric_limits<float>::lowest();
    glm::vec4 reach(kLowest);  // right, left, upper, lower
    glm::vec2 depth(-kLowest, kLowest);
    for (const glm::vec3& p : points) {
        const glm::vec3 v(glm::dot(p, axes.right), glm::dot(p, axes.upwards),
                          glm::dot(p, axes.backwards));
        reach = glm::max(reach, glm::vec4(v.x + tan_x * v.z, -v.x + tan_x * v.z, v.y + tan_y * v.z,
                                          -v.y + tan_y * v.z));
        depth = glm::vec2(std::min(depth.x, v.z), std::max(depth.y, v.z));
    }
    if (points.empty()) {
        reach = glm::vec4(std::hypot(1.0f, tan_x), std::hypot(1.0f, tan_x), std::hypot(1.0f, tan_y),
                          std::hypot(1.0f, tan_y));
        depth = glm::vec2(-1.0f, 1.0f);
    }
    const glm::vec2 middle(0.5f * (reach.x - reach.y), 0.5f * (reach.z - reach.w));
    const float eye_depth = std::max({0.5f * (reach.x + reach.y) / tan_x,
                                      0.5f * (reach.z + reach.w) / tan_y, depth.y + kMinDistance});
    const glm::vec3 line = middle.x * axes.right + middle.y * axes.upwards;
    camera.target = line + 0.5f * (depth.x + depth.y) * axes.backwards;
    camera.eye = line + eye_depth * axes.backwards;
    return camera;
}

void orbit(Camera& camera, float azimuth_deg, float elevation_deg)
{
    ViewDirection direction = direction_of(camera);
    direction.azimuth_deg += azimuth_deg;
    direction.elevation_deg =
        glm::clamp(direction.elevation_deg + elevation_deg, -kMaxElevationDeg, kMaxElevationDeg);
    const float distance = glm::distance(camera.eye, camera.target);
    camera.eye = camera.target + distance * towards_eye(camera.up, direction);
}

void move_frame(Camera& camera, glm::vec3 offset, float scale)
{
    camera.eye = scale * camera.eye + offset;
    camera.target = scale * camera.target + offset;
}

void pan(Camera& camera, glm::vec2 share)
{
    const CameraAxes axes = camera_axes(camera);
    const float height = 2.0f * std::tan(0.5f * glm::radians(camera.fovy_deg)) *
                         glm::distance(camera.eye, camera.target);
    const glm::vec3 step = -height * (share.x * axes.right + share.y * axes.upwards);
    camera.eye += step;
    camera.target += step;
}

void zoom(Camera& camera, float factor)
{
    SURFELAO_CHECK(factor > 0.0f);
    const glm::vec3 arm = camera.eye - camera.target;
    const float distance = glm::length(arm);
    camera.eye = camera.target +
                 arm * (glm::clamp(distance * factor, kMinDistance, kMaxDistance) / distance);
}

namespace {

[[noreturn]] void refuse(std::string_view part, const char* wanted)
{
    throw SettingsError("--camera: \"" + std::string(part) + "\" was found, " + wanted +
                        " was wanted");
}

double parse_number(std::string_view part, std::string_view text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        refuse(part, "a number");
    return value;
}

float parse_between(std::string_view part, std::string_view text, double low, double high,
                    const char* wanted)
{
    const double value = parse_number(part, text);
    if (!(value >= low && value <= high))
        refuse(part, wanted);
    return static_cast<float>(value);
}

glm::dvec3 parse_point(std::string_view part, std::string_view text)
{
    const std::size_t first = text.find(':');
    const std::size_t second = first == text.npos ? text.npos : text.find(':', first + 1);
    if (second == text.npos)
        refuse(part, "X:Y:Z");
    return {parse_number(part, text.substr(0, first)),
            parse_number(part, text.substr(first + 1, second - first - 1)),
            parse_number(part, text.substr(second + 1))};
}

}  // namespace

Camera parse_camera(std::string_view text, const CameraWishes& wishes)
{
    ViewDirection direction;
    float fovy_deg = Camera().fovy_deg;
    float distance = 1.0f;
    bool has_angles = false;
    std::optional<glm::vec3> eye, target;
    const auto to_unit = [&](glm::dvec3 p) {
        return glm::vec3((p - wishes.frame_centre) / wishes.frame_diagonal);
    };

    while (!text.empty()) {
        const std::string_view part = text.substr(0, text.find(','));
        text.remove_prefix(std::min(part.size() + 1, text.size()));
        const std::size_t equals = part.find('=');
        const std::string_view name = part.substr(0, equals);
        const std::string_view value = equals == part.npos ? "" : part.substr(equals + 1);
        if (name == "azimuth") {
            direction.azimuth_deg = parse_between(part, value, -3600.0, 3600.0, "-3600 to 3600");
            has_angles = true;
        } else if (name == "elevation") {
            direction.elevation_deg = parse_between(part, value, -90.0, 90.0, "-90 to 90");
            has_angles = true;
        } else if (name == "distance") {
            distance = parse_between(part, value, 0.01, 100.0, "0.01 to 100");
            has_angles = true;
        } else if (name == "fov") {
            fovy_deg = parse_between(part, value, 1.0, 170.0, "1 to 170 degrees");
        } else if (name == "eye") {
            eye = to_unit(parse_point(part, value));
        } else if (name == "target") {
            target = to_unit(parse_point(part, value));
        } else {
            refuse(part, "azimuth=, elevation=, distance=, fov=, eye= or target=");
        }
    }
    if (eye && has_angles)
        throw SettingsError(
            "--camera: eye= together with azimuth=, elevation= or distance= says two things");

    Camera camera = frame_points(wishes.points, wishes.up, wishes.aspect, direction, fovy_deg);
    if (target) {
        camera.eye += *target - camera.target;
        camera.target = *target;
    }
    if (eye)
        camera.eye = *eye;
    camera.eye = camera.target + distance * (camera.eye - camera.target);
    if (glm::distance(camera.eye, camera.target) < 1e-6f)
        throw SettingsError("--camera: eye and target are the same place");
    return camera;
}

}  // namespace surfelao
