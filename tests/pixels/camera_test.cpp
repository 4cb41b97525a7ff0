#include "pixels/camera.h"

#include "surfels/errors.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace surfelao {
namespace {

glm::vec2 on_screen(const Camera& camera, float aspect, glm::vec3 point)
{
    const glm::vec4 clip = projection_matrix(camera, aspect, 0.01f, 100.0f) * view_matrix(camera) *
                           glm::vec4(point, 1);
    return glm::vec2(clip) / clip.w;
}

const std::vector<glm::vec3> kBox = {
    {-0.3f, -0.2f, -0.1f}, {0.3f, -0.2f, -0.1f}, {-0.3f, 0.2f, -0.1f}, {0.3f, 0.2f, -0.1f},
    {-0.3f, -0.2f, 0.1f},  {0.3f, -0.2f, 0.1f},  {-0.3f, 0.2f, 0.1f},  {0.3f, 0.2f, 0.1f}};

// A point at distance d and height d * tan(fovy / 2) lies on the upper edge.
TEST(Camera, FieldOfViewIsFromTheUpperToTheLowerEdge)
{
    Camera camera;
    camera.eye = {0, 0, 3};
    camera.target = {0, 0, 0};
    camera.fovy_deg = 90.0f;
    EXPECT_NEAR(on_screen(camera, 2.0f, {0, 3, 0}).y, 1.0f, 1e-5f);
    EXPECT_NEAR(on_screen(camera, 2.0f, {6, 0, 0}).x, 1.0f, 1e-5f);
}

TEST(Camera, SeesTheSameInAnotherFrame)
{
    const Camera camera = frame_points(kBox, UpAxis::z, 1.5f);
    Camera moved = camera;
    const glm::vec3 offset(5, -2, 1);
    move_frame(moved, offset, 0.5f);
    for (const glm::vec3& point : kBox) {
        const glm::vec2 before = on_screen(camera, 1.5f, point);
        const glm::vec2 after = on_screen(moved, 1.5f, 0.5f * point + offset);
        EXPECT_NEAR(before.x, after.x, 1e-4f);
        EXPECT_NEAR(before.y, after.y, 1e-4f);
    }
}

TEST(Camera, AzimuthTurnsCounterClockwiseSeenFromAbove)
{
    const Camera front =
        frame_points(kBox, UpAxis::y, 1.0f, {.azimuth_deg = 0, .elevation_deg = 0});
    EXPECT_GT(front.eye.z, 1.0f);
    const Camera side =
        frame_points(kBox, UpAxis::y, 1.0f, {.azimuth_deg = 90, .elevation_deg = 0});
    EXPECT_GT(side.eye.x, 0.5f);
    const Camera z_front =
        frame_points(kBox, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 0});
    EXPECT_LT(z_front.eye.y, -0.5f);
    const Camera z_side =
        frame_points(kBox, UpAxis::z, 1.0f, {.azimuth_deg = 90, .elevation_deg = 0});
    EXPECT_GT(z_side.eye.x, 0.5f);
}

// All points are inside the margin, and in the direction that is tight two opposite ones touch it.
TEST(FramePoints, FitsExactlyForAnyShapeOfThePicture)
{
    for (float aspect : {0.3f, 1.0f, 1.78f, 5.0f}) {
        for (float fovy_deg : {10.0f, 35.0f, 120.0f}) {
            const Camera camera = frame_points(kBox, UpAxis::y, aspect, {}, fovy_deg);
            glm::vec2 low(1e9f), high(-1e9f);
            for (const glm::vec3& point : kBox) {
                low = glm::min(low, on_screen(camera, aspect, point));
                high = glm::max(high, on_screen(camera, aspect, point));
            }
            EXPECT_LE(std::max({-low.x, -low.y, high.x, high.y}), 0.9f + 1e-4f);
            const bool tight_x = std::abs(low.x + 0.9f) < 1e-3f && std::abs(high.x - 0.9f) < 1e-3f;
            const bool tight_y = std::abs(low.y + 0.9f) < 1e-3f && std::abs(high.y - 0.9f) < 1e-3f;
            EXPECT_TRUE(tight_x || tight_y) << aspect << ", " << fovy_deg;
        }
    }
}

TEST(FramePoints, OnePointAndNoneGiveAUsableCamera)
{
    const Camera one = frame_points(std::vector<glm::vec3>{{1, 2, 3}}, UpAxis::y, 1.0f);
    EXPECT_GT(glm::distance(one.eye, one.target), 0.0f);
    const Camera none = frame_points({}, UpAxis::y, 1.0f);
    EXPECT_GT(glm::length(none.eye), 1.0f);
}

TEST(Camera, LookingStraightDownKeepsItsAxesRight)
{
    const Camera camera =
        frame_points(kBox, UpAxis::y, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
    const CameraAxes axes = camera_axes(camera);
    EXPECT_NEAR(glm::length(axes.right), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::length(axes.upwards), 1.0f, 1e-5f);
    EXPECT_NEAR(axes.backwards.y, 1.0f, 1e-5f);
}

TEST(Camera, OrbitKeepsTheDistanceAndStopsBeforeThePoles)
{
    Camera camera = frame_points(kBox, UpAxis::y, 1.0f);
    const float distance = glm::distance(camera.eye, camera.target);
    orbit(camera, 400.0f, 300.0f);
    EXPECT_NEAR(glm::distance(camera.eye, camera.target), distance, 1e-5f);
    EXPECT_LT(camera_axes(camera).backwards.y, 0.99995f);
    orbit(camera, 0.0f, -500.0f);
    EXPECT_LT(camera_axes(camera).backwards.y, -0.99f);
}

TEST(Camera, OrbitBackReturns)
{
    Camera camera = frame_points(kBox, UpAxis::z, 1.0f);
    const glm::vec3 eye = camera.eye;
    orbit(camera, 33.0f, 21.0f);
    EXPECT_GT(glm::distance(camera.eye, eye), 0.1f);
    orbit(camera, -33.0f, -21.0f);
    EXPECT_NEAR(glm::distance(camera.eye, eye), 0.0f, 1e-4f);
}

// Panning by half of the picture's height brings the target to the upper edge.
TEST(Camera, PanFollowsTheMouse)
{
    Camera camera = frame_points(kBox, UpAxis::y, 1.0f);
    const glm::vec3 target = camera.target;
    pan(camera, {0.0f, 0.5f});
    EXPECT_NEAR(on_screen(camera, 1.0f, target).y, 1.0f, 1e-4f);
}

TEST(Camera, ZoomStaysInItsBounds)
{
    Camera camera = frame_points(kBox, UpAxis::y, 1.0f);
    for (int i = 0; i < 1000; ++i)
        zoom(camera, 0.5f);
    EXPECT_NEAR(glm::distance(camera.eye, camera.target), 1e-4f, 1e-6f);
    for (int i = 0; i < 1000; ++i)
        zoom(camera, 2.0f);
    EXPECT_NEAR(glm::distance(camera.eye, camera.target), 1e3f, 1.0f);
}

CameraWishes wishes()
{
    return {.points = kBox, .frame_centre = {100, 0, 0}, .frame_diagonal = 10.0, .aspect = 1.5f};
}

TEST(ParseCamera, NothingSaidIsTheFramedView)
{
    const Camera framed = frame_points(kBox, UpAxis::y, 1.5f);
    EXPECT_EQ(parse_camera("", wishes()).eye, framed.eye);
    EXPECT_EQ(parse_camera("distance=1", wishes()).eye, framed.eye);
}

TEST(ParseCamera, ReadsAnglesAndDistance)
{
    const Camera camera = parse_camera("azimuth=90,elevation=0,distance=2,fov=50", wishes());
    const Camera framed =
        frame_points(kBox, UpAxis::y, 1.5f, {.azimuth_deg = 90, .elevation_deg = 0}, 50.0f);
    EXPECT_EQ(camera.fovy_deg, 50.0f);
    EXPECT_NEAR(glm::distance(camera.eye, camera.target),
                2.0f * glm::distance(framed.eye, framed.target), 1e-5f);
}

TEST(ParseCamera, EyeAndTargetAreInTheFilesUnits)
{
    const Camera camera = parse_camera("eye=110:0:0,target=100:5:0", wishes());
    EXPECT_NEAR(glm::distance(camera.eye, glm::vec3(1, 0, 0)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(camera.target, glm::vec3(0, 0.5f, 0)), 0.0f, 1e-6f);
}

TEST(ParseCamera, RefusesWhatItDoesNotUnderstand)
{
    for (const char* text :
         {"azimut=3", "azimuth", "azimuth=", "azimuth=3x", "azimuth=nan", "elevation=91",
          "distance=0", "fov=0", "fov=171", "eye=1:2", "eye=1:2:3:4", "eye=1:2:3,azimuth=4",
          "eye=1:2:3,target=1:2:3", ",", "azimuth=1,,elevation=2", "eye=1e400:0:0"}) {
        EXPECT_THROW((void)parse_camera(text, wishes()), SettingsError) << text;
    }
}

}  // namespace
}  // namespace surfelao
