// Pictures by OSMesa: the same pixels everywhere.

#include "viewer/render.h"

#include "golden.h"
#include "image/color_map.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "viewer/solve_model.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace surfelao {
namespace {

Model model_of(const Scene& scene, UpAxis up = UpAxis::z)
{
    return make_model(make_mesh(scene), up);
}

/// One splat per vertex, however large.
Model surfels_of(const Scene& scene)
{
    return make_model(make_mesh(scene), UpAxis::z, {}, std::numeric_limits<float>::infinity());
}

std::vector<Occlusion> all(const Model& model, float occlusion)
{
    std::vector<Occlusion> values;
    for (std::size_t i = 0; i < model.geometry().positions.size(); ++i)
        values.push_back({occlusion, model.mesh->surface.normals[i]});
    for (const Receiver& receiver : model.ground_receivers)
        values.push_back({occlusion, receiver.normal});
    return values;
}

/// Small, by OSMesa, without the ground: only the model differs from the background.
RenderOptions plain(Shape surface, int width, int height)
{
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples = 1;
    options.view.surface = surface;
    options.view.ground = false;
    options.backend = GlBackend::osmesa;
    return options;
}

/// Open surfaces are lighter than any background.
bool is_model(const glm::vec4& pixel)
{
    return pixel.r > 0.6f;
}

std::size_t model_pixels(const Image& image)
{
    return static_cast<std::size_t>(
        std::count_if(image.pixels.begin(), image.pixels.end(), is_model));
}

Image draw_open(const Model& model, const Camera& camera, const RenderOptions& options)
{
    return render(model, all(model, 0.0f), {}, camera, options);
}

/// The largest and the least distance of the mask's rim from the circle of its area, in pixels.
struct Roundness {
    double outside = 0.0;  ///< of the farthest model pixel beyond the circle
    double inside = 0.0;   ///< of the innermost missing pixel
};
Roundness roundness(const Image& image)
{
    glm::dvec2 centre(0.0);
    double count = 0.0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (is_model(image.at(x, y))) {
                centre += glm::dvec2(x, y);
                count += 1.0;
            }
        }
    }
    centre /= count;
    const double radius = std::sqrt(count / 3.14159265358979);
    Roundness result;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double beyond = glm::distance(glm::dvec2(x, y), centre) - radius;
            if (is_model(image.at(x, y)))
                result.outside = std::max(result.outside, beyond);
            else
                result.inside = std::max(result.inside, -beyond);
        }
    }
    return result;
}

// 1,538 surfels on a sphere that is 216 pixels wide. A disk at the rim sticks out by its sagitta
// r^2 / (2 R), here 0.5 pixels.
TEST(Splats, ASpheresOutlineIsRound)
{
    const Model model = surfels_of(scenes::sphere({0, 0, 0}, 1.0, 16));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    const Roundness disks = roundness(draw_open(model, camera, plain(Shape::splats, 240, 240)));
    EXPECT_LT(disks.outside, 1.0);
    EXPECT_LT(disks.inside, 1.0);
    const Roundness affine = roundness(draw_open(model, camera, plain(Shape::affine, 240, 240)));
    EXPECT_LT(affine.outside, 1.0);
    // what plain sprites do instead
    const Roundness points = roundness(draw_open(model, camera, plain(Shape::points, 240, 240)));
    EXPECT_GT(points.outside, 2.0);
}

/// How many pixels that triangles cover the surface leaves open.
std::size_t holes(const Model& model, const Camera& camera, Shape surface)
{
    const Image triangles = draw_open(model, camera, plain(Shape::triangles, 320, 200));
    const Image other = draw_open(model, camera, plain(surface, 320, 200));
    EXPECT_GT(model_pixels(triangles), 1000u);
    std::size_t count = 0;
    for (std::size_t i = 0; i < other.pixels.size(); ++i)
        count += is_model(triangles.pixels[i]) && !is_model(other.pixels[i]);
    return count;
}

// From 2 degrees above a floor that reaches to the eye. The report's affine form loses the floor.
TEST(Splats, AFloorAtAGrazingAngleKeepsItsCoverage)
{
    const Model model = surfels_of(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 24));
    Camera camera;
    camera.up = {0, 0, 1};
    camera.eye = {0.0f, -0.6f, 0.02f};
    camera.target = {0.0f, 0.0f, 0.0f};
    EXPECT_EQ(holes(model, camera, Shape::splats), 0u);
    EXPECT_GT(holes(model, camera, Shape::affine), 500u);
}

TEST(Splats, ABumpySurfaceHasNoHoles)
{
    const Model model = surfels_of(scenes::bumpy_sphere(24));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.6f);
    EXPECT_EQ(holes(model, camera, Shape::splats), 0u);
}

// A room of two triangles a wall: no splat is missing inside, none sticks out at the corners.
TEST(Splats, CoarseTrianglesAreCoveredAndNotExceeded)
{
    const Model model = model_of(scenes::box({0, 0, 0}, {1, 2, 1}, 1));
    for (const float elevation_deg : {2.0f, 30.0f}) {
        const Camera camera =
            frame_points(model.seen, UpAxis::z, 1.6f, {.elevation_deg = elevation_deg});
        EXPECT_EQ(holes(model, camera, Shape::splats), 0u);
        const auto pixels = [&](Shape surface) {
            return static_cast<double>(
                model_pixels(draw_open(model, camera, plain(surface, 320, 200))));
        };
        EXPECT_NEAR(pixels(Shape::splats) / pixels(Shape::triangles), 1.0, 0.01);
    }
}

// A flat sheet seen from straight above: the disks of its rim stick out by exactly one radius,
// which is R * h * cot(fovy / 2) / (2 * depth) pixels.
TEST(Splats, HaveTheRightSizeForAnyFieldOfView)
{
    const Model model = surfels_of(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 8));
    for (const float fovy_deg : {10.0f, 45.0f, 120.0f}) {
        Camera camera = frame_points(model.seen, UpAxis::z, 1.0f,
                                     {.azimuth_deg = 0, .elevation_deg = 90}, fovy_deg);
        zoom(camera, 1.5f);
        const auto width = [&](Shape surface) {
            const Image image = draw_open(model, camera, plain(surface, 400, 400));
            int low = image.width, high = 0;
            for (int y = 0; y < image.height; ++y) {
                for (int x = 0; x < image.width; ++x) {
                    if (is_model(image.at(x, y))) {
                        low = std::min(low, x);
                        high = std::max(high, x + 1);
                    }
                }
            }
            return high - low;
        };
        const float depth = glm::distance(camera.eye, camera.target);
        const float radius = model.splat_radii[0] * 400.0f /
                             (std::tan(glm::radians(fovy_deg) / 2.0f) * 2.0f * depth);
        const int triangles = width(Shape::triangles);
        for (Shape surface : {Shape::splats, Shape::affine, Shape::points})
            EXPECT_NEAR(width(surface) - triangles, 2.0f * radius, 2.0f) << fovy_deg;
    }
}

// Points of OpenGL end at 255 pixels on this device.
TEST(Splats, MayBeLargerThanTheDevicesPoints)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}};
    const Model model = surfels_of(scene);
    Camera camera =
        frame_points(model.seen, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
    zoom(camera, 0.4f);
    for (Shape surface : {Shape::splats, Shape::affine, Shape::points}) {
        const Image image = draw_open(model, camera, plain(surface, 700, 700));
        EXPECT_EQ(model_pixels(image), 700u * 700u);
    }
}

TEST(Render, TheGroundIsDarkerUnderTheModelAndOnlyThere)
{
    const Model model = model_of(scenes::box({0, 0, 0}, {1, 1, 1}, 2));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.5f);
    RenderOptions options = plain(Shape::triangles, 150, 100);
    const Image without = render(model, all(model, 0.0f), {}, camera, options);
    options.view.ground = true;
    EXPECT_EQ(render(model, all(model, 0.0f), {}, camera, options).pixels, without.pixels);
    std::vector<Occlusion> dark = all(model, 0.0f);
    for (std::size_t i = model.geometry().positions.size(); i < dark.size(); ++i)
        dark[i].occlusion = 0.5f;
    const Image with = render(model, dark, {}, camera, options);
    EXPECT_LT(with.at(75, 97).r, 0.6f * without.at(75, 97).r);
    EXPECT_EQ(with.at(75, 40), without.at(75, 40));  // the box
    EXPECT_EQ(with.at(2, 2), without.at(2, 2));      // above the horizon
    // seen from below it hides nothing
    Camera below = frame_points(model.seen, UpAxis::z, 1.5f, {.elevation_deg = -30});
    options.view.ground = false;
    const Image free = render(model, dark, {}, below, options);
    options.view.ground = true;
    EXPECT_EQ(render(model, dark, {}, below, options).pixels, free.pixels);
}

TEST(Render, RightOfTheWipeTheReferenceIsShown)
{
    const Model model = model_of(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2));
    const Camera camera =
        frame_points(model.seen, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
    RenderOptions options = plain(Shape::triangles, 100, 100);
    options.view.wipe = 0.5f;
    const Image image = render(model, all(model, 0.0f), all(model, 1.0f), camera, options);
    EXPECT_GT(image.at(48, 50).r, 0.8f);
    EXPECT_EQ(image.at(52, 50).r, 0.0f);
    options.view.wipe = 1.0f;
    options.view.colors = Colors::rays;
    EXPECT_EQ(render(model, all(model, 0.0f), all(model, 1.0f), camera, options).at(48, 50).r,
              0.0f);
}

TEST(Render, TheDifferenceIsAHeatMapWithItsLegend)
{
    const Model model = model_of(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2));
    const Camera camera =
        frame_points(model.seen, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
    RenderOptions options = plain(Shape::triangles, 300, 300);
    options.view.colors = Colors::difference;
    options.view.difference_scale = 0.2f;
    const auto middle = [&](float own, float reference) {
        const Image image = render(model, all(model, own), all(model, reference), camera, options);
        EXPECT_LT(image.at(10, 290).r, 0.05f);  // the legend's plate
        return glm::vec3(image.at(150, 150));
    };
    EXPECT_LT(glm::distance(middle(0.3f, 0.3f), map_color(ColorMap::heat, 0.0f)), 0.01f);
    EXPECT_LT(glm::distance(middle(0.3f, 0.4f), map_color(ColorMap::heat, 0.5f)), 0.01f);
    EXPECT_LT(glm::distance(middle(0.4f, 0.3f), map_color(ColorMap::heat, 0.5f)), 0.01f);
    EXPECT_LT(glm::distance(middle(0.9f, 0.1f), map_color(ColorMap::heat, 1.0f)), 0.01f);
}

TEST(Render, ASignedDifferenceSaysWhichWayInASuitableScale)
{
    const Model model = model_of(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2));
    const Camera camera =
        frame_points(model.seen, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
    RenderOptions options = plain(Shape::triangles, 300, 300);
    options.view.colors = Colors::difference;
    options.view.is_signed = true;
    options.view.difference_scale = 0.2f;
    const auto middle = [&](float own, float reference) {
        return glm::vec3(
            render(model, all(model, own), all(model, reference), camera, options).at(150, 150));
    };
    const auto shown = [](float place) { return map_color(ColorMap::diverging, place); };
    EXPECT_LT(glm::distance(middle(0.3f, 0.3f), glm::vec3(1.0f)), 0.01f);
    EXPECT_LT(glm::distance(middle(0.4f, 0.3f), shown(0.75f)), 0.01f);
    EXPECT_LT(glm::distance(middle(0.3f, 0.4f), shown(0.25f)), 0.01f);
    // to 0.05, the next scale, of 0.04
    options.fit_scale = true;
    EXPECT_LT(glm::distance(middle(0.34f, 0.3f), shown(0.9f)), 0.01f);
    for (const Shape shape : {Shape::splats, Shape::points}) {
        options.view.surface = shape;
        EXPECT_LT(glm::distance(middle(0.3f, 0.34f), shown(0.1f)), 0.01f);
    }
}

// Put over a colour, the transparent picture is the one that was drawn on it: edges, shadow and
// all.
TEST(Render, ATransparentBackgroundTakesAnyColour)
{
    const Model model = model_of(scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.5f);
    RenderOptions options = plain(Shape::triangles, 60, 40);
    options.samples = 5;
    options.view.ground = true;
    const auto on = [&](glm::vec4 background) {
        options.view.background = background;
        return render(model, all(model, 0.5f), {}, camera, options);
    };
    const Image clear = on(glm::vec4(0.0f));
    for (const glm::vec3 color : {glm::vec3(1.0f), glm::vec3(0.0f), glm::vec3(0.1f, 0.5f, 0.9f)}) {
        const Image opaque = on(glm::vec4(color, 1.0f));
        for (std::size_t i = 0; i < clear.pixels.size(); ++i) {
            const glm::vec4& pixel = clear.pixels[i];
            EXPECT_LT(glm::distance(glm::mix(color, glm::vec3(pixel), pixel.a),
                                    glm::vec3(opaque.pixels[i])),
                      1e-5f);
            EXPECT_EQ(opaque.pixels[i].a, 1.0f);
        }
    }
    EXPECT_EQ(clear.at(0, 0), glm::vec4(0.0f));
    EXPECT_EQ(clear.at(30, 20).a, 1.0f);
    EXPECT_TRUE(std::ranges::any_of(clear.pixels, [](const glm::vec4& pixel) {
        return pixel.a > 0.1f && pixel.a < 0.9f && pixel.r > 0.1f;  // an edge of the box
    }));
}

// A cube of eight vertices: each of the three faces in sight is of one colour, its edges too. Mean
// normals would run through all colours between.
TEST(Render, HardEdgesHaveTheNormalsOfTheirSides)
{
    const Model model = model_of(scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    ASSERT_EQ(model.geometry().positions.size(), 8u);
    RenderOptions options = plain(Shape::triangles, 60, 60);
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    options.view.colors = Colors::visibility;
    const Image open = draw_open(model, camera, options);
    options.view.colors = Colors::normals;
    const Image image = draw_open(model, camera, options);
    std::vector<glm::vec3> colors;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const glm::vec3 color(image.pixels[i]);
        const auto alike = [&](glm::vec3 other) { return glm::distance(color, other) < 0.01f; };
        if (is_model(open.pixels[i]) && std::none_of(colors.begin(), colors.end(), alike))
            colors.push_back(color);
    }
    EXPECT_EQ(colors.size(), 3u);
}

// Light from +x only: a surface that bends towards it is lit, whatever its own normal.
TEST(Render, TheEnvironmentIsLookedUpAlongTheBentNormal)
{
    const Model model = model_of(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2));
    const Camera camera =
        frame_points(model.seen, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
    RenderOptions options = plain(Shape::triangles, 60, 60);
    options.view.colors = Colors::environment;
    options.environment = Image(64, 32, glm::vec4(0.0f));
    for (int y = 10; y < 22; ++y)
        for (int x = 26; x < 38; ++x)
            options.environment->at(x, y) = glm::vec4(1.0f);
    const auto lit = [&](glm::vec3 bent, float occlusion) {
        std::vector<Occlusion> values = all(model, occlusion);
        for (Occlusion& value : values)
            value.bent_normal = bent;
        return render(model, values, {}, camera, options).at(30, 30).r;
    };
    EXPECT_GT(lit({1, 0, 0}, 0.0f), 0.3f);
    EXPECT_LT(lit({-1, 0, 0}, 0.0f), 0.01f);
    EXPECT_LT(lit({1, 0, 0}, 0.75f), 0.6f * lit({1, 0, 0}, 0.0f));
    EXPECT_EQ(lit({1, 0, 0}, 1.0f), 0.0f);
}

TEST(Render, SamplesSmoothTheEdges)
{
    const Model model = model_of(scenes::sphere({0, 0, 0}, 1.0, 8));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    RenderOptions options = plain(Shape::triangles, 64, 64);
    const auto steps = [&](int samples) {
        options.samples = samples;
        const Image image = draw_open(model, camera, options);
        return std::count_if(image.pixels.begin(), image.pixels.end(), [](const glm::vec4& pixel) {
            return pixel.r > 0.5f && pixel.r < 0.85f;
        });
    };
    EXPECT_EQ(steps(1), 0);
    EXPECT_GT(steps(16), 30);
}

TEST(Render, TheSamePictureTwiceIsTheSameBytes)
{
    const Model model = model_of(scenes::bumpy_sphere(8));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    for (Shape surface : {Shape::triangles, Shape::splats}) {
        const RenderOptions options = plain(surface, 64, 64);
        EXPECT_EQ(draw_open(model, camera, options).pixels,
                  draw_open(model, camera, options).pixels);
    }
}

TEST(Render, ASceneWithoutAreaIsBackground)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    scene.triangles = {{0, 1, 2}};
    const Model model = model_of(scene);
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    for (Shape surface : {Shape::triangles, Shape::splats, Shape::affine, Shape::points})
        EXPECT_EQ(model_pixels(draw_open(model, camera, plain(surface, 32, 32))), 0u);
}

TEST(Render, SizesThatCannotBeDrawnAreRefused)
{
    const Model model = model_of(scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    for (const glm::ivec2 size : {glm::ivec2(0, 10), glm::ivec2(10, 0), glm::ivec2(-1, 10),
                                  glm::ivec2(1000000, 10), glm::ivec2(10, 1000000)})
        EXPECT_THROW((void)draw_open(model, camera, plain(Shape::triangles, size.x, size.y)),
                     InputError)
            << size.x << " x " << size.y;
}

TEST(Render, CanBeCancelled)
{
    const Model model = model_of(scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    EXPECT_THROW((void)render(model, all(model, 0.0f), {}, camera, plain(Shape::triangles, 32, 32),
                              [](double) { return false; }),
                 Cancelled);
}

// --- golden pictures ---------------------------------------------------------------------------

/// A bumpy ball in a corner of two walls over a floor: all kinds of occlusion in few triangles.
Scene corner_with_ball()
{
    using namespace scenes;
    return sheet({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 16) +
           sheet({-2, 2, 0}, {4, 0, 0}, {0, 0, 3}, 12) +
           sheet({-2, -2, 0}, {0, 4, 0}, {0, 0, 3}, 12) +
           moved(bumpy_sphere(12), [](glm::dvec3 p) { return p + glm::dvec3(0, 0, 1.1); });
}

struct Golden {
    const char* name;
    Shape surface;
    Colors colors;
};

TEST(Render, LooksAsItDidWhenItWasLookedAt)
{
    const Model model = surfels_of(corner_with_ball());
    const Prepared rays = prepare(model.geometry(), {.engine = Engine::rays});
    const std::vector<Occlusion> reference = solve_model(rays, model, {.rays = 256}).values;
    // few rays: something to see in the difference
    const std::vector<Occlusion> own = solve_model(rays, model, {.rays = 64}).values;
    const Camera camera =
        frame_points(model.seen, UpAxis::z, 4.0f / 3.0f, {.azimuth_deg = 40, .elevation_deg = 20});
    for (const Golden& golden : {
             Golden{"triangles", Shape::triangles, Colors::rays},
             Golden{"splats", Shape::splats, Colors::rays},
             Golden{"affine", Shape::affine, Colors::rays},
             Golden{"points", Shape::points, Colors::rays},
             Golden{"difference", Shape::triangles, Colors::difference},
             Golden{"bent_normals", Shape::triangles, Colors::bent_normals},
             Golden{"normals", Shape::splats, Colors::normals},
             Golden{"levels", Shape::splats, Colors::levels},
             Golden{"environment", Shape::triangles, Colors::environment},
         }) {
        RenderOptions options = plain(golden.surface, 200, 150);
        options.samples = 4;
        options.view.colors = golden.colors;
        options.view.ground = true;
        test::expect_golden(golden.name, render(model, own, reference, camera, options));
    }
}

}  // namespace
}  // namespace surfelao
