#include "pixels/seen.h"

#include "looks.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <optional>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

/// The nearest triangle on a ray from a point, by trying all, and how far.
std::optional<float> nearest_hit(const Geometry& geometry, glm::vec3 from, glm::vec3 direction)
{
    std::optional<float> nearest;
    for (const glm::uvec3 t : geometry.triangles) {
        const glm::dvec3 a(geometry.positions[t.x]), d(direction);
        const glm::dvec3 across = glm::dvec3(geometry.positions[t.y]) - a;
        const glm::dvec3 along = glm::dvec3(geometry.positions[t.z]) - a;
        const glm::dvec3 face = glm::cross(across, along);
        const glm::dvec3 turned = glm::cross(glm::dvec3(from) - a, d);
        const double facing = -glm::dot(face, d);
        const double u = glm::dot(turned, along) / facing, v = -glm::dot(turned, across) / facing;
        const double distance = glm::dot(glm::dvec3(from) - a, face) / facing;
        if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0 && (!nearest || distance < *nearest))
            nearest = static_cast<float>(distance);
    }
    return nearest;
}

/// Cameras of both kinds, one of them inside of the scene, one that looks past it.
std::vector<View> views()
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(12));
    View outside = view_of(frame_points(mesh.geometry.positions, UpAxis::y, 1.5f), 60, 40);
    View orthographic = outside;
    orthographic.lens = {{-0.6f, -0.4f}, {0.6f, 0.4f}, true};
    View inside = outside;
    inside.eye = glm::vec3(0.02f, 0.01f, -0.03f);
    View aside = outside;  // the scene is at the edge of a wide picture
    aside.forward = glm::normalize(outside.forward + outside.right);
    aside.right = glm::normalize(outside.right - outside.forward);
    aside.lens = {{-1.5f, -1.0f}, {1.5f, 1.0f}, false};
    return {outside, orthographic, inside, aside};
}

TEST(Seen, IsTheNearestTriangleOnEachPixelsRay)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(12));
    int hits = 0, misses = 0;
    for (const View& view : views()) {
        const Look look(mesh, view, {60, 40});
        const GBuffer& buffer = look.pixels.g_buffer();
        const std::vector<std::uint32_t> triangles = buffer.read_triangles();
        const std::vector<glm::vec4> surface = buffer.read_surface();
        const SeenPixels& seen = look.pixels.seen();
        std::size_t next = 0;
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            const PixelRay ray = pixel_ray(view.lens, 60, 40, glm::vec2(i % 60, i / 60) + 0.5f);
            const std::optional<float> true_distance =
                nearest_hit(mesh.geometry, to_world(view, ray.origin),
                            to_world(view, ray.direction) - view.eye);
            if (triangles[i] == 0) {
                EXPECT_EQ(surface[i], glm::vec4(0, 0, 0, kNothingThere));
                misses += true_distance.has_value() ? 1 : 0;
                continue;
            }
            ASSERT_EQ(seen.pixels[next], i);
            const Receiver& receiver = seen.receivers[next++];
            if (!true_distance) {  // at the very edge: the device rounds corners to 1/256 pixel
                ++misses;
                continue;
            }
            ++hits;
            EXPECT_NEAR(surface[i].w, *true_distance, 2e-4f) << i;
            const glm::vec3 point = ray.origin + *true_distance * ray.direction;
            EXPECT_LT(glm::distance(to_view(view, receiver.position), point), 4e-4f) << i;
            // the texture's normal is the receiver's, but for those that face away from the eye
            const glm::vec3 normal = to_view(view, view.eye + receiver.normal);
            if (glm::dot(normal, ray.direction) < 0.0f) {
                EXPECT_LT(glm::distance(normal, glm::vec3(surface[i])), 1e-3f) << i;
            }
        }
        EXPECT_EQ(next, seen.pixels.size());
    }
    EXPECT_GT(hits, 3500);
    EXPECT_LT(misses, 30);
}

// From inside, all that is seen of a closed body are back sides: the receiver is turned over and
// lies on the eye's side of the triangle.
TEST(Seen, FromBehindReceiversAreTurnedOver)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1.0, 8));
    View view = view_of(Camera{}, 16, 16);
    view.eye = glm::vec3(0.0f);
    view.forward = glm::vec3(0, 0, -1);
    const Look look(mesh, view, {16, 16});
    ASSERT_EQ(look.pixels.seen().receivers.size(), 256u);
    const float radius = glm::length(mesh.geometry.positions[0]);
    for (std::size_t i = 0; i < 256; ++i) {
        const Receiver& receiver = look.pixels.seen().receivers[i];
        EXPECT_LT(glm::dot(receiver.normal, receiver.position), 0.0f);
        EXPECT_LT(glm::length(receiver.position), radius);
        const SurfacePoint point = look.pixels.seen().points[i];
        const Receiver outside = receivers_at(mesh.geometry, mesh.surface, {&point, 1})[0];
        EXPECT_GT(glm::length(outside.position), glm::length(receiver.position));
    }
}

// The far side of a ball is never seen, whichever way its triangles were wound, nor are those
// triangles of a box that face away.
TEST(Seen, RimsShowTheNearerTriangle)
{
    const Scene ball = scenes::sphere({0, 0, 0}, 1.0, 24);
    const Scene box = scenes::box({-1, -0.6, -0.3}, {1, 0.6, 0.3}, 2);
    for (const Scene& scene : {ball, scenes::flipped(ball), box, scenes::flipped(box)}) {
        const Mesh mesh = make_mesh(scene, {.source = NormalSource::flat});
        int inside = 0;
        for (int k = 0; k < 12; ++k) {
            const ViewDirection direction{37.0f * static_cast<float>(k),
                                          11.0f * static_cast<float>(k) - 60.0f};
            const View view = view_of(
                frame_points(mesh.geometry.positions, UpAxis::y, 1.0f, direction), 400, 400);
            const Look look(mesh, view, {400, 400});
            for (const Receiver& receiver : look.pixels.seen().receivers)
                inside += glm::dot(receiver.normal, receiver.position) < 0.0f ? 1 : 0;
        }
        EXPECT_EQ(inside, 0);
    }
}

// Two sheets a millionth of the scene apart, looked at from inside of it: the nearer one is seen
// everywhere.
TEST(Seen, DepthTellsNearbySheetsApart)
{
    const auto sheet = [](double z) { return scenes::sheet({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, 1); };
    const Mesh mesh = make_mesh(sheet(-1.0) + sheet(-1.0 - 3e-6));
    View view = view_of(Camera{}, 64, 64);
    view.eye = glm::vec3(0.0f, 0.0f, 0.3f);
    view.forward = glm::vec3(0, 0, -1);
    const Look look(mesh, view, {64, 64});
    for (const SurfacePoint& point : look.pixels.seen().points)
        ASSERT_LT(point.triangle, 2u);
    EXPECT_EQ(look.pixels.seen().points.size(), 64u * 64u);
}

// A picture drawn in parts is the picture.
TEST(Seen, PartsOfAPictureMakeItUp)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(12));
    const View whole = views()[0];
    const Look look(mesh, whole, {60, 40});
    const std::vector<std::uint32_t> triangles = look.pixels.g_buffer().read_triangles();
    View lower = whole;
    lower.lens = part_of(whole.lens, 60, 40, {0, 0, 60, 10});
    View upper = whole;
    upper.lens = part_of(whole.lens, 60, 40, {0, 10, 60, 30});
    std::vector<std::uint32_t> joined =
        Look(mesh, lower, {60, 10}).pixels.g_buffer().read_triangles();
    for (const std::uint32_t t : Look(mesh, upper, {60, 30}).pixels.g_buffer().read_triangles())
        joined.push_back(t);
    int others = 0;
    for (std::size_t i = 0; i < joined.size(); ++i)
        others += joined[i] != triangles[i] ? 1 : 0;
    EXPECT_LE(others, 10);  // the device rounds corners to 1/256 pixel, differently in each part
    // and with a guard the inner pixels are the same
    const Look guarded(mesh, whole, {60, 40}, 8);
    EXPECT_EQ(guarded.pixels.g_buffer().width(), 76);
    EXPECT_NEAR(static_cast<double>(guarded.pixels.seen().pixels.size()),
                static_cast<double>(look.pixels.seen().pixels.size()), 10.0);
}

TEST(Seen, PartsAreThoseOfTheScene)
{
    const Mesh mesh =
        make_mesh(scenes::box({0, 0, 0}, {1, 1, 1}, 1) + scenes::box({2, 0, 0}, {3, 1, 1}, 1));
    const std::vector<std::uint32_t> parts = parts_of(mesh);
    ASSERT_EQ(parts.size(), 24u);
    EXPECT_EQ(parts[0], 0u);
    EXPECT_EQ(parts[23], mesh.scene.parts.size() - 1);
}

}  // namespace
}  // namespace surfelao
