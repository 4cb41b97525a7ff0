/// camera.h: where a picture is taken from. All lengths in the unit frame of geometry.h: the middle
/// of the scene's box is the origin, its diagonal is 1.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <string_view>

namespace surfelao {

/// Which axis of the file points to the sky.
enum class UpAxis { y, z };

[[nodiscard]] glm::vec3 up_direction(UpAxis up);

/// A pinhole. Invariants: eye and target differ; 1 <= fovy_deg <= 170.
struct Camera {
    glm::vec3 eye{0.0f, 0.0f, 2.0f};
    glm::vec3 target{0.0f};  ///< seen in the middle of the picture; what orbiting turns about
    glm::vec3 up{0.0f, 1.0f, 0.0f};  ///< unit length
    float fovy_deg = 35.0f;          ///< from the upper to the lower edge of the picture
    bool operator==(const Camera&) const = default;
};

/// Unit vectors: to the right and upwards in the picture, and from the scene towards the eye.
/// Well defined also where the camera looks along `up`.
struct CameraAxes {
    glm::vec3 right, upwards, backwards;
};
[[nodiscard]] CameraAxes camera_axes(const Camera& camera);

/// World to view: the eye at the origin, looking along -z.
[[nodiscard]] glm::mat4 view_matrix(const Camera& camera);

/// View to clip space, OpenGL's depth range. `shift` moves the picture by that share of clip space
/// (2 = the whole width): for sub-pixel samples. 0 < near < far.
[[nodiscard]] glm::mat4 projection_matrix(const Camera& camera, float aspect, float near, float far,
                                          glm::vec2 shift = glm::vec2(0.0f));

/// Where inside a pixel the sample of that index lies, -0.5 to 0.5: any first n of them are spread
/// evenly, and the first is the middle.
///
/// Based on:
///   Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018 (R2)
[[nodiscard]] glm::vec2 sample_shift(int index);

/// From where to look when nothing is said: a little from the side and from above.
struct ViewDirection {
    float azimuth_deg = 30.0f;    ///< 0 = from +z (up y) or from -y (up z); grows counter-clockwise
                                  ///< as seen from above
    float elevation_deg = 18.0f;  ///< 90 = from straight above
};

/// The camera in that direction that sees all points, as large as they fit with a margin of a
/// twentieth of the picture around them. Exact for any aspect (width / height) and field of view.
/// No points: the unit ball is framed. O(points).
[[nodiscard]] Camera frame_points(std::span<const glm::vec3> points, UpAxis up, float aspect,
                                  const ViewDirection& direction = {}, float fovy_deg = 35.0f);

/// Turns about the target: azimuth about `up`, elevation kept short of the poles.
void orbit(Camera& camera, float azimuth_deg, float elevation_deg);

/// Moves eye and target alike by a share of the picture's height, so that what lies at the target
/// follows the mouse.
void pan(Camera& camera, glm::vec2 share);

/// Multiplies the distance to the target; factor > 0. The distance stays between 1e-4 and 1e3.
void zoom(Camera& camera, float factor);

/// The same view when lengths become `scale` times what they were and then move by `offset`: the
/// frame of the model is another one.
void move_frame(Camera& camera, glm::vec3 offset, float scale);

/// What a camera's description is about.
struct CameraWishes {
    std::span<const glm::vec3> points;  ///< to be seen; unit frame
    glm::dvec3 frame_centre{0.0};       ///< of the unit frame: world = centre + diagonal * unit
    double frame_diagonal = 1.0;
    UpAxis up = UpAxis::y;
    float aspect = 1.0f;
};

/// Reads "azimuth=30,elevation=20,distance=1.5,fov=35" or "eye=X:Y:Z,target=X:Y:Z,fov=35", any part
/// of either. Angles in degrees, eye and target in the file's own units, distance as a multiple of
/// the framed one. What is not said is framed on the points. Throws SettingsError with one sentence
/// for anything else: unknown names, numbers that are none or out of range, angles together with an
/// eye.
[[nodiscard]] Camera parse_camera(std::string_view text, const CameraWishes& wishes);

}  // namespace surfelao
