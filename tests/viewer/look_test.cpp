// Ways to look at a model, and to move while looking.

#include "files/scene_io.h"
#include "image/map.h"
#include "scenes.h"
#include "surfels/srgb.h"
#include "temporary_folder.h"
#include "viewer/coarse.h"
#include "viewer/flight.h"
#include "viewer/probe.h"
#include "viewer/render.h"
#include "viewer/renderer.h"
#include "viewer/sample_sum.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

constexpr int kSide = 81;  // of pictures: odd, so that a pixel's middle is theirs
constexpr int kMiddle = kSide / 2;

Model upright_model(const Scene& scene)
{
    return make_model(make_mesh(scene), UpAxis::z);
}

Image look_at(const Model& model, const Camera& camera, float occlusion, const ViewOptions& view)
{
    RenderOptions options;
    options.width = options.height = kSide;
    options.samples = 1;
    options.view = view;
    options.view.ground = false;
    options.backend = GlBackend::osmesa;
    const std::vector<Occlusion> values(model.answer_count(), {occlusion, {0.0f, 0.0f, 1.0f}});
    return render(model, values, {}, camera, options);
}

Scene floor_of(int cells)
{
    return scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, cells);
}

// Seen from 30 degrees above: the cosine to the light at the eye is 1/2, from below too.
TEST(Headlight, IsLambertTimesVisibility)
{
    const Model model = upright_model(floor_of(2));
    for (const float elevation_deg : {30.0f, -30.0f}) {
        const Camera camera =
            frame_points(model.seen, UpAxis::z, 1.0f, {.elevation_deg = elevation_deg});
        const Image image = look_at(model, camera, 0.25f, {.colors = Colors::headlight});
        // the middle of the picture may be a little off the target, half a degree at most
        EXPECT_NEAR(image.at(kMiddle, kMiddle).r, srgb_decode(0.94f) * 0.75f * 0.5f, 0.01f);
    }
}

bool is_line(const glm::vec4& pixel)
{
    return pixel.b > 1.5f * pixel.r;
}

// One square from straight above. Its diagonal is a line of the same width from near and far, and
// beside it nothing changes.
TEST(Wireframe, IsAsWideFromNearAndFar)
{
    const Model model = upright_model(floor_of(1));
    std::vector<int> widths;
    for (const float distance : {0.5f, 1.0f}) {
        Camera camera = frame_points(model.seen, UpAxis::z, 1.0f, {.elevation_deg = 90});
        zoom(camera, distance);
        const Image plain = look_at(model, camera, 0.5f, {});
        const Image lines = look_at(model, camera, 0.5f, {.wireframe = true});
        int width = 0, others = 0;
        for (int x = 5; x < kSide - 5; ++x) {
            width += is_line(lines.at(x, kMiddle + 10));
            others += lines.at(x, kMiddle + 10) != plain.at(x, kMiddle + 10) &&
                      !is_line(lines.at(x, kMiddle + 10));
        }
        widths.push_back(width);
        EXPECT_LE(others, 2) << "the line's soft edges";
    }
    EXPECT_EQ(widths[0], widths[1]);
    EXPECT_GE(widths[0], 1);
    EXPECT_LE(widths[0], 3);
}

TEST(Culling, OpensARoomFromBehindAndChangesNothingFromTheFront)
{
    const Model model = upright_model(scenes::box({0, 0, 0}, {1, 1, 1}, 2));
    const Camera outside = frame_points(model.seen, UpAxis::z, 1.0f);
    EXPECT_EQ(look_at(model, outside, 0.0f, {.cull = true}).pixels,
              look_at(model, outside, 0.0f, {}).pixels);
    Camera inside = outside;
    inside.eye = {0.0f, 0.0f, 0.0f};
    inside.target = {0.2f, 0.1f, 0.0f};
    const auto light = [](const Image& image) { return image.at(kMiddle, kMiddle).r > 0.8f; };
    EXPECT_TRUE(light(look_at(model, inside, 0.0f, {})));
    EXPECT_FALSE(light(look_at(model, inside, 0.0f, {.cull = true})));
}

TEST(FlightTest, KeysMoveAndTheMouseTurnsAboutTheEye)
{
    Camera camera;  // from z = 2 along -z
    EXPECT_EQ(flight_step("W", 0.5f, 2.0), glm::vec3(0, 0, 1));
    EXPECT_EQ(flight_step("WS", 0.5f, 2.0), glm::vec3(0.0f));
    EXPECT_NEAR(glm::length(flight_step("WDE", 0.5f, 2.0)), 1.0f, 1e-6f);
    fly(camera, flight_step("W", 0.5f, 2.0));
    EXPECT_NEAR(glm::distance(camera.eye, glm::vec3(0, 0, 1)), 0.0f, 1e-6f);
    fly(camera, flight_step("D", 0.5f, 1.0));
    EXPECT_NEAR(glm::distance(camera.eye, glm::vec3(0.5f, 0, 1)), 0.0f, 1e-6f);
    look_around(camera, 90.0f, 0.0f);
    EXPECT_NEAR(glm::distance(camera.eye, glm::vec3(0.5f, 0, 1)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(-camera_axes(camera).backwards, glm::vec3(1, 0, 0)), 0.0f, 1e-5f);
    look_around(camera, 0.0f, 30.0f);
    EXPECT_NEAR(-camera_axes(camera).backwards.y, 0.5f, 1e-5f);
    EXPECT_NEAR(glm::distance(camera.eye, camera.target), 2.0f, 1e-5f);
}

// A thin plate keeps both of its sides, and what is left looks the same way.
TEST(Coarse, FewerTrianglesOfTheSameShape)
{
    const Model plate = upright_model(scenes::box({0, 0, 0}, {1, 1, 0.001}, 24));
    const Geometry& geometry = plate.geometry();
    const Surface& surface = plate.mesh->surface;
    EXPECT_EQ(coarse_triangles(geometry, surface, geometry.triangles.size()),
              surface.corners(geometry));
    const std::vector<glm::uvec3> coarse = coarse_triangles(geometry, surface, 800);
    EXPECT_LE(coarse.size(), 800u);
    EXPECT_GT(coarse.size(), 200u);
    double top = 0.0, bottom = 0.0, whole = 0.0;
    const auto twice_area = [&](const glm::uvec3& vertices) {
        const glm::vec3 a = geometry.positions[vertices.x];
        return glm::cross(geometry.positions[vertices.y] - a, geometry.positions[vertices.z] - a);
    };
    for (const glm::uvec3& t : coarse) {
        const glm::vec3 area =
            twice_area({surface.vertex_of(t.x), surface.vertex_of(t.y), surface.vertex_of(t.z)});
        (surface.normals[t.x].z > 0.9f ? top : bottom) += static_cast<double>(area.z);
    }
    for (const glm::uvec3& t : geometry.triangles)
        whole += std::max(0.0, static_cast<double>(twice_area(t).z));
    // corners are pulled inwards by half a cell, a fortieth of the side, at each end
    EXPECT_NEAR(top / whole, 1.0, 0.12);
    EXPECT_NEAR(bottom / whole, -1.0, 0.12);
}

TEST(Coarse, TheFinestThatIsFastEnoughIsDrawn)
{
    EXPECT_EQ(moving_detail({}), 0u);
    EXPECT_EQ(moving_detail({10.0, 5.0, {}, {}}), 0u);
    EXPECT_EQ(moving_detail({200.0, {}, {}, {}}), 1u);
    EXPECT_EQ(moving_detail({200.0, 80.0, 30.0, {}}), 2u);
    EXPECT_EQ(moving_detail({200.0, 80.0, 70.0, 60.0}), 3u);
}

// A ball of 9,600 triangles, and of 1,000 at half as many pixels.
TEST(Coarse, APictureIsLikeTheWholeOne)
{
    const Model model = upright_model(scenes::sphere({0, 0, 0}, 1.0, 40));
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.0f);
    const GlContext context = GlContext::create(GlBackend::osmesa);
    Renderer renderer(context);
    renderer.set_model(model);
    renderer.set_coarse(coarse_triangles(model.geometry(), model.mesh->surface, 1000));
    const auto draw = [&](const ViewOptions& view, int pixel) {
        const Framebuffer target = renderer.make_target(80 / pixel, 80 / pixel);
        SampleSum sum(context, 80, 80);
        renderer.draw_frame(target, camera, view);
        sum.add(target, pixel);
        return sum.mean();
    };
    for (const Shape shape : {Shape::triangles, Shape::splats}) {
        ViewOptions view{.surface = shape, .colors = Colors::headlight, .ground = false};
        const Image whole = draw(view, 1);
        view.coarse = true;
        const Image coarse = draw(view, 2);
        double sum = 0.0;
        for (std::size_t i = 0; i < whole.pixels.size(); ++i)
            sum += std::abs(static_cast<double>(whole.pixels[i].r - coarse.pixels[i].r));
        EXPECT_LT(sum / static_cast<double>(whole.pixels.size()), 0.03);
        EXPECT_NE(whole.pixels, coarse.pixels);
    }
}

/// A floor with a box over it, in a cell that is solved.
struct Probe : testing::Test {
    void SetUp() override
    {
        using scenes::operator+;
        setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
        write_obj(folder / "two.obj", scenes::sheet({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 12) +
                                          scenes::box({-0.5, 0.2, -0.5}, {0.5, 1.2, 0.5}, 4));
        view.session().open(folder / "two.obj", UpAxis::y);
    }

    /// Until the cell has its whole answer; at most half a minute.
    bool is_solved(const Cell& cell)
    {
        view.session().solve(cell.settings);
        for (int i = 0; i < 30000; ++i) {
            static_cast<void>(view.update());
            const SessionState& state = view.session().state();
            if (state.model) {
                camera = frame_points(state.model->seen, UpAxis::y, 1.0f);
                static_cast<void>(view.look(cell, camera, {kSide, kSide}, {}));
            }
            const bool is_whole = state.is_solved && !state.is_draft && !view.is_busy() &&
                                  (state.layout != nullptr) == cell.settings.texels.has_value();
            if (is_whole && view.has_pixels() == cell.at_pixels)
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }

    TemporaryFolder folder;
    const GlContext context = GlContext::create(GlBackend::osmesa);
    CellView view{context};
    Camera camera;
};

TEST_F(Probe, ReadsWhatWasSolvedAtVerticesTexelsAndPixels)
{
    const SurfacePoint point{100, {0.2f, 0.7f}};
    Cell cell;
    ASSERT_TRUE(is_solved(cell));
    const Geometry& geometry = view.model()->geometry();
    const Reading at_vertex = read_at(view, cell, point, {0, 0});
    EXPECT_EQ(at_vertex.vertex, geometry.triangles[100].z);
    EXPECT_EQ(at_vertex.own, view.session().occlusion()[at_vertex.vertex]);
    EXPECT_FALSE(at_vertex.reference.has_value());
    EXPECT_NEAR(
        glm::distance(at_vertex.position, view.model()->mesh->scene.positions[at_vertex.vertex]),
        0.0, 1e-6);
    EXPECT_NEAR(at_vertex.normal.y, 1.0f, 1e-6f);

    set_where(cell, Where::pixels, {});
    ASSERT_TRUE(is_solved(cell));
    const PixelAnswers& answers = view.pixels();
    const auto shaded = std::ranges::find_if(answers.picture,
                                             [](const glm::vec4& texel) { return texel.w > 0.1f; });
    ASSERT_NE(shaded, answers.picture.end());
    const auto index = static_cast<int>(shaded - answers.picture.begin());
    const Reading at_pixel = read_at(view, cell, point, {index % kSide, index / kSide});
    EXPECT_EQ(at_pixel.own, (Occlusion{shaded->w, glm::vec3(*shaded)}));

    set_where(cell, Where::texels, {.texels = {.size = 64}, .grid = {}});
    ASSERT_TRUE(is_solved(cell));
    const Reading at_texel = read_at(view, cell, point, {0, 0});
    ASSERT_TRUE(at_texel.own.has_value());
    // the same floor, by other receivers: a texel is a fortieth of it
    EXPECT_NEAR(at_texel.own->occlusion, at_vertex.own->occlusion, 0.05f);
    EXPECT_NEAR(at_texel.position.y, 0.0, 1e-6);
}

}  // namespace
}  // namespace surfelao
