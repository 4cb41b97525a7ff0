// Colours at pixels are those of the shaders: an open ball looks as it does with values at
// vertices.

#include "viewer/pixel_paint.h"

#include "scenes.h"
#include "viewer/render.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {
namespace {

TEST(PixelPaint, LightIsThatOfTheShaders)
{
    const Model model = make_model(make_mesh(scenes::sphere({0, 0, 0}, 1.0, 24)), UpAxis::z);
    const Mesh& mesh = *model.mesh;
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.5f);
    const GlContext context = GlContext::create(GlBackend::osmesa);
    const DrawnMesh drawn(context, mesh.geometry, mesh.surface);
    Occluders occluders(mesh.geometry);
    std::vector<Occlusion> open;
    for (const glm::vec3& normal : mesh.surface.normals)
        open.push_back({0.0f, normal});
    open.resize(model.answer_count());
    const PixelPictureSettings settings{.size = {60, 40}, .engine = EngineSettings{}};
    for (const Colors colors : {Colors::environment, Colors::normals, Colors::headlight}) {
        RenderOptions options;
        options.width = 60;
        options.height = 40;
        options.view.colors = colors;
        options.view.ground = false;
        options.view.exposure = 0.7f;
        options.backend = GlBackend::osmesa;
        const Image at_vertices = render(model, open, {}, camera, options);
        context.make_current();
        Image image = pixel_picture(context, mesh, drawn, occluders, view_of(camera, 60, 40),
                                    settings, pixel_paint(options.view, camera, nullptr, nullptr))
                          .image;
        if (shows_numbers(colors))
            show_numbers(image);
        put_on_background(context, image, camera, options.view, nullptr);
        std::vector<float> differences;
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            differences.push_back(glm::distance(image.pixels[i], at_vertices.pixels[i]));
        std::ranges::sort(differences);
        // but for the rim, where samples of one pixel see normals far apart
        EXPECT_LT(differences[differences.size() * 85 / 100], 2.0f / 255.0f)
            << static_cast<int>(colors);
        EXPECT_LT(differences.back(), 0.3f) << static_cast<int>(colors);
    }
}

TEST(PixelPaint, DifferencesTakeTheirColoursFromThePicture)
{
    const ViewOptions options{.colors = Colors::difference, .is_signed = true};
    Image image(3, 1);
    image.at(0, 0) = {0.5f, 0.46f, 0.0f, 1.0f};
    image.at(1, 0) = {0.5f, 0.54f, 0.0f, 0.25f};
    show_difference(image, options, true);  // to 0.05
    EXPECT_EQ(image.at(1, 0).a, 0.25f);
    EXPECT_EQ(image.at(2, 0), glm::vec4(0.0f));
    EXPECT_LT(glm::distance(glm::vec3(image.at(0, 0)), map_color(ColorMap::diverging, 0.9f)),
              1e-5f);
    EXPECT_LT(glm::distance(glm::vec3(image.at(1, 0)), map_color(ColorMap::diverging, 0.1f)),
              1e-5f);
}

// Under an even sky it does not matter from where the light is that a grid takes; under half a sky
// it does.
TEST(PixelPaint, GridsTakeTheLightOfTheirCones)
{
    auto grid = std::make_shared<AoGrid>();
    grid->cells = glm::ivec3(2);
    grid->low = glm::dvec3(-1.0);
    grid->high = glm::dvec3(1.0);
    for (int cell = 0; cell < 8; ++cell)  // a cap of 60 degrees along x
        grid->values.insert(grid->values.end(), {0.1875f, 0.0f, 0.0f, 0.25f});
    GridPixels grids;
    grids.world = std::make_shared<GridWorld>(std::vector<PlacedGrid>{{grid, {}}},
                                              std::make_shared<const Geometry>());
    const Receiver receiver{{0.0f, 0.0f, 0.0f}, {0, 1, 0}, 0.0f};
    const Occlusion value =
        solve_with_grids(grids, std::span<const Receiver>(&receiver, 1)).front();
    ASSERT_GT(value.occlusion, 0.15f);
    const auto shown = [&](const Image& sky, const GridPixels* taking) {
        const PixelPaint paint = pixel_paint({.colors = Colors::environment, .exposure = -2.0f},
                                             Camera{}, &sky, nullptr);
        return paint.color({receiver, value, value, false, taking}).r;
    };
    Image even(64, 32), half(64, 32);
    std::ranges::fill(even.pixels, glm::vec4(1.0f));
    std::ranges::fill(half.pixels, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    for (int y = 0; y < 32; ++y)
        for (int x = 16; x < 48; ++x)  // the middle column looks along x
            half.at(x, y) = glm::vec4(1.0f);
    EXPECT_NEAR(shown(even, &grids), shown(even, nullptr), 1e-4f);
    EXPECT_LT(shown(half, &grids), 0.93f * shown(half, nullptr));
}

}  // namespace
}  // namespace surfelao
