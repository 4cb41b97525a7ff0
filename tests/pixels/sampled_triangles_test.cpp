#include "pixels/sampled_triangles.h"

#include "engines/threads.h"
#include "looks.h"
#include "pixels/camera.h"
#include "pixels/edge_pixels.h"
#include "pixels/pixel_samples.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numeric>
#include <random>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr PictureSize kPicture{48, 40};

std::vector<std::uint32_t> all_pixels()
{
    std::vector<std::uint32_t> pixels(static_cast<std::size_t>(kPicture.width * kPicture.height));
    std::iota(pixels.begin(), pixels.end(), 0u);
    return pixels;
}

std::vector<glm::vec2> shifts(int count)
{
    std::vector<glm::vec2> places;
    for (int i = 1; i <= count; ++i)
        places.push_back(sample_shift(i));
    return places;
}

/// From outside at all of it.
View outside(const Geometry& geometry)
{
    return view_of(frame_points(geometry.positions, UpAxis::y, 1.2f), kPicture.width,
                   kPicture.height);
}
/// From its middle, a wide angle: triangles lie before, behind and on both sides of the eye.
View inside()
{
    Camera camera;
    camera.eye = glm::vec3(0.03f, 0.02f, 0.01f);
    camera.target = glm::vec3(-0.4f, -0.2f, -0.3f);
    camera.fovy_deg = 100.0f;
    return view_of(camera, kPicture.width, kPicture.height);
}
View without_perspective()
{
    View view = inside();
    view.lens = {glm::vec2(-0.4f), glm::vec2(0.4f), true};
    return view;
}

/// Where a ray meets a triangle, forward from the eye, and how far within; in doubles, by Cramer's
/// rule.
struct Meeting {
    double forward = -1.0;
    double margin = -1.0;  ///< the least barycentric weight
};
Meeting meet(const Geometry& geometry, const View& view, const PixelRay& ray, std::size_t triangle)
{
    const glm::uvec3 t = geometry.triangles[triangle];
    const glm::dvec3 a(to_view(view, geometry.positions[t.x])),
        u = glm::dvec3(to_view(view, geometry.positions[t.y])) - a,
        v = glm::dvec3(to_view(view, geometry.positions[t.z])) - a;
    const glm::dvec3 origin(ray.origin), along(ray.direction), from = origin - a;
    const glm::dvec3 face = glm::cross(u, v);
    const double facing = -glm::dot(face, along);
    if (std::abs(facing) < 1e-14)
        return {};
    const double s = glm::dot(glm::cross(from, along), v) / facing,
                 r = -glm::dot(glm::cross(from, along), u) / facing;
    return {origin.z + glm::dot(face, from) / facing * along.z, std::min({s, r, 1.0 - s - r})};
}

struct Counts {
    int seen = 0, wrong = 0;
};

/// Rays through every sample against all triangles; those beside an edge or another surface are
/// left out.
Counts compare_with_rays(const Geometry& geometry, const View& view)
{
    const std::vector<std::uint32_t> pixels = all_pixels();
    const std::vector<glm::vec2> places = shifts(2);
    const Projected projected(geometry, view, kPicture.width, kPicture.height);
    const auto triangles = sampled_triangles(projected, pixels, places);
    Counts counts;
    for (std::size_t s = 0; s < places.size(); ++s) {
        for (const std::uint32_t pixel : pixels) {
            const glm::vec2 at = glm::vec2(pixel % kPicture.width, pixel / kPicture.width) + 0.5f;
            const PixelRay ray =
                pixel_ray(view.lens, kPicture.width, kPicture.height, at + places[s]);
            double nearest = 1e30, next = 1e30, closest = 1e30;
            std::uint32_t expected = 0;
            for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
                const Meeting meeting = meet(geometry, view, ray, t);
                if (meeting.forward <= kBeforeEye)
                    continue;
                closest = std::min(closest, std::abs(meeting.margin));
                if (meeting.margin < 0.0)
                    continue;
                next = std::min(next, std::max(meeting.forward, nearest));
                if (meeting.forward < nearest) {
                    nearest = meeting.forward;
                    expected = static_cast<std::uint32_t>(t) + 1;
                }
            }
            if (closest < 1e-4 || next - nearest < 1e-4)
                continue;
            counts.seen += expected != 0 ? 1 : 0;
            counts.wrong += triangles[s][pixel] != expected ? 1 : 0;
        }
    }
    return counts;
}

TEST(SampledTriangles, AreThoseThatRaysMeet)
{
    const Mesh bumpy = make_mesh(scenes::bumpy_sphere(6));
    const Mesh room = make_mesh(scenes::room({-1, -1, -1}, {1, 1, 1}, 2) +
                                scenes::box({-0.9, -1, -0.8}, {-0.3, 0.1, -0.2}, 1));
    for (const auto& [mesh, view] : {std::pair{&bumpy, outside(bumpy.geometry)},
                                     {&bumpy, inside()},
                                     {&room, inside()},
                                     {&room, without_perspective()}}) {
        const Counts counts = compare_with_rays(mesh->geometry, view);
        EXPECT_GT(counts.seen, 1000);
        EXPECT_EQ(counts.wrong, 0);
    }
}

// In blocks of pixels, the last of them beyond the picture on both sides.
TEST(SampledTriangles, OfMiddlesAreThoseOfEachPixelAlone)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(12));
    for (const View& view : {outside(mesh.geometry), without_perspective()}) {
        const Projected projected(mesh.geometry, view, kPicture.width - 1, kPicture.height - 3);
        std::vector<std::uint32_t> pixels(
            static_cast<std::size_t>((kPicture.width - 1) * (kPicture.height - 3)));
        std::iota(pixels.begin(), pixels.end(), 0u);
        const std::vector<glm::vec2> middle{glm::vec2(0.0f)};
        EXPECT_EQ(middle_triangles(projected), sampled_triangles(projected, pixels, middle)[0]);
    }
}

// Triangles that share a side leave no gap: a body seen from within hides all that is behind.
TEST(SampledTriangles, LeaveNoGapBetweenThem)
{
    const Mesh mesh = make_mesh(scenes::sphere(glm::dvec3(0.0), 1.0, 40));
    const Projected projected(mesh.geometry, inside(), kPicture.width, kPicture.height);
    for (const auto& triangles : sampled_triangles(projected, all_pixels(), shifts(16)))
        EXPECT_EQ(std::ranges::count(triangles, 0u), 0);
}

TEST(SampledTriangles, AreTheSameForSomePixelsAndForAnyNumberOfThreads)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(12));
    const View view = outside(mesh.geometry);
    const Projected projected(mesh.geometry, view, kPicture.width, kPicture.height);
    const auto all = sampled_triangles(projected, all_pixels(), shifts(7));
    std::vector<std::uint32_t> some;
    for (std::uint32_t pixel = 3;
         pixel < static_cast<std::uint32_t>(kPicture.width * kPicture.height);
         pixel += pixel % 5 + 1)
        some.push_back(pixel);
    const ThreadLimit limit(1);
    const auto fewer = sampled_triangles(projected, some, shifts(7));
    for (std::size_t s = 0; s < all.size(); ++s) {
        for (std::size_t i = 0; i < some.size(); ++i)
            EXPECT_EQ(fewer[s][i], all[s][some[i]]);
    }
}

/// Receivers beside the middles' that sixteen samples of these pixels ask for.
std::size_t extras_of(const Mesh& mesh, const View& view, const SeenPixels& middles,
                      const std::vector<std::uint32_t>& pixels)
{
    const std::vector<std::uint32_t> parts = parts_of(mesh);
    const Projected projected(mesh.geometry, view, kPicture.width, kPicture.height);
    PixelSamples samples(mesh, parts, middles, pixels, 16);
    const std::vector<glm::vec2> places = shifts(15);
    const auto triangles = sampled_triangles(projected, pixels, places);
    for (std::size_t s = 0; s < places.size(); ++s) {
        View sample = view;
        sample.lens = shifted(view.lens, kPicture.width, kPicture.height, places[s]);
        samples.add(sample, triangles[s]);
    }
    return samples.extras().size();
}

// Bodies that stick in each other, a hard edge, and a wire a twentieth of a pixel wide, that
// middles miss nearly everywhere.
TEST(EdgePixels, AreAllThatSeeMoreThanOneSurface)
{
    const Mesh crossing = make_mesh(scenes::sheet({-1, -1, -0.3}, {2, 0, 0}, {0, 2, 0.6}, 1) +
                                    scenes::sheet({-1, -1, 0.3}, {2, 0, 0}, {0, 2, -0.6}, 1));
    const Mesh wire =
        make_mesh(scenes::sheet({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, 1) +
                  scenes::sheet({-0.9, -0.7, 0.2}, {1.7, 1.3, 0}, {0.001, -0.002, 0}, 1));
    const Mesh box = make_mesh(scenes::box({-1, -1, -1}, {1, 1, 1}, 3));
    for (const Mesh* mesh : {&crossing, &wire, &box}) {
        const View view = outside(mesh->geometry);
        const Look look(*mesh, view, kPicture);
        const SeenPixels& middles = look.pixels.seen();
        const std::vector<std::uint32_t> parts = parts_of(*mesh);
        const Projected projected(mesh->geometry, view, kPicture.width, kPicture.height);
        const std::vector<std::uint32_t> found = EdgeFinder(*mesh, parts).find(projected, middles);
        const std::size_t all = extras_of(*mesh, view, middles, all_pixels());
        EXPECT_GT(all, 20u);
        EXPECT_EQ(extras_of(*mesh, view, middles, found), all);
        EXPECT_LT(found.size(), all_pixels().size() / 3);
    }
}

}  // namespace
}  // namespace surfelao
