#include "pixels/grid_pass.h"

#include "looks.h"
#include "sphere_grid.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace surfelao {
namespace {

constexpr PictureSize kSize{96, 64};

/// A dent and a hill: pixels of many normals and distances.
const Mesh& hills()
{
    static const Mesh mesh = make_mesh(scenes::height_field(
        24, [](double x, double y) { return 0.2 * std::sin(6.0 * x) * std::cos(5.0 * y); }));
    return mesh;
}

View looking_at_hills(glm::vec3 eye)
{
    Camera camera;
    camera.eye = eye;
    camera.target = glm::vec3(0.0f);
    camera.up = glm::vec3(0, 0, 1);
    return view_of(camera, kSize.width, kSize.height);
}

Placement placed_at(glm::dvec3 place, double scale, double turn, bool is_mirrored = false)
{
    Placement placement;
    placement.rotation =
        glm::dmat3(glm::rotate(glm::dmat4(1.0), turn, glm::normalize(glm::dvec3(1, 2, 3))));
    if (is_mirrored)
        placement.rotation[0] = -placement.rotation[0];
    placement.scale = scale;
    placement.translation = place;
    return placement;
}

std::vector<PlacedGrid> three_balls(GridStore store, GridBorder border)
{
    const auto grid = std::make_shared<const AoGrid>(sphere_grid(1.0, 3.0, 16, store, border));
    return {{grid, placed_at({0.1, 0.1, 0.12}, 0.1, 0.4)},
            {grid, placed_at({-0.15, 0.0, 0.1}, 0.07, 1.3, true), {0.0, 0.2, 0.4}, 2},
            {grid, placed_at({0.0, -0.2, 0.15}, 0.12, 2.0)}};
}

/// Largest difference to visibility_at() at any pixel; mean: of the twin's occlusion. The picture's
/// left half is on the second surface, which hides a tenth from itself.
float largest_difference(const View& view, std::span<const PlacedGrid> objects, GridMerge merge,
                         double& mean)
{
    const DrawnMesh drawn(test_context(), hills().geometry, hills().surface);
    GBuffer seen(test_context(), kSize.width, kSize.height);
    seen.draw(drawn, view);
    GridPass pass(test_context());
    const Framebuffer target = pass.make_target(kSize.width, kSize.height);
    std::vector<glm::vec2> texels;
    for (int i = 0; i < kSize.width * kSize.height; ++i)
        texels.emplace_back(i % 96 < 48 ? glm::vec2(0.9f, 2.0f) : glm::vec2(1.0f, 0.0f));
    const Texture2D own(test_context(), kSize.width, kSize.height, TexelFormat::rg32f,
                        std::span<const glm::vec2>(texels));
    pass.draw(seen, objects, merge, target, &own);
    const std::vector<float> found = target.read_red(target.rect());
    const std::vector<glm::vec4> surface = seen.read_surface();
    float largest = 0.0f;
    mean = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        float expected = texels[i].x;
        if (surface[i].w < kNothingThere) {
            const glm::vec2 middle(static_cast<float>(i % 96) + 0.5f,
                                   static_cast<float>(i / 96) + 0.5f);
            const PixelRay ray = pixel_ray(view.lens, kSize.width, kSize.height, middle);
            const glm::vec3 normal(surface[i]);
            expected *= visibility_at(
                objects, merge, to_world(view, ray.origin + surface[i].w * ray.direction),
                normal.x * view.right + normal.y * view.up + normal.z * view.forward,
                static_cast<std::uint32_t>(texels[i].y));
        }
        mean += (1.0 - static_cast<double>(expected)) / static_cast<double>(found.size());
        largest = std::max(largest, std::abs(found[i] - expected));
    }
    return largest;
}

TEST(GridPass, IsItsTwinAtEveryPixel)
{
    for (const GridStore store : {GridStore::cone, GridStore::sh}) {
        for (const GridBorder border : {GridBorder::fade, GridBorder::rescale}) {
            for (const GridMerge merge : {GridMerge::product, GridMerge::caps}) {
                double mean = 0.0;
                EXPECT_LE(largest_difference(looking_at_hills({0.3f, -1.2f, 0.8f}),
                                             three_balls(store, border), merge, mean),
                          0.003f)
                    << name_of(store) << ' ' << name_of(border) << ' ' << name_of(merge);
                EXPECT_GT(mean, 0.02);
            }
        }
    }
}

TEST(GridPass, SeesTheSameWithTheEyeInsideOfTheBoxAndWithoutPerspective)
{
    const auto balls = three_balls(GridStore::cone, GridBorder::fade);
    double mean = 0.0;
    EXPECT_LE(
        largest_difference(looking_at_hills({0.1f, 0.0f, 0.35f}), balls, GridMerge::product, mean),
        0.003f);
    EXPECT_GT(mean, 0.05);
    View flat = looking_at_hills({0.3f, -1.2f, 0.8f});
    flat.lens.orthographic = true;
    EXPECT_LE(largest_difference(flat, balls, GridMerge::product, mean), 0.003f);
    EXPECT_GT(mean, 0.02);
}

// All widths of caps and all ways to cut them: of one width everywhere in the box.
TEST(GridPass, CutsCapsByTheHorizon)
{
    for (const float alpha : {0.01f, 0.05f, 0.15f, 0.3f, 0.45f, 0.5f, 0.55f, 0.7f, 0.9f, 0.99f}) {
        AoGrid grid = sphere_grid(1.0, 3.0, 4, GridStore::cone, GridBorder::rescale);
        const glm::vec3 mean =
            alpha * (1.0f - alpha) * glm::normalize(glm::vec3(0.2f, -1.0f, 0.1f));
        for (std::size_t i = 0; i < grid.values.size(); i += 4) {
            for (int c = 0; c < 3; ++c)
                grid.values[i + c] = mean[c];
            grid.values[i + 3] = alpha;
        }
        grid.border_value = 0.0f;
        const std::vector<PlacedGrid> objects{
            {std::make_shared<const AoGrid>(grid), placed_at(glm::dvec3(0.0), 1.0, 0.7)}};
        double mean_occlusion = 0.0;
        EXPECT_LE(largest_difference(looking_at_hills({0.3f, -1.2f, 0.8f}), objects,
                                     GridMerge::product, mean_occlusion),
                  0.0015f)
            << alpha;
        EXPECT_GT(mean_occlusion, 0.1 * double{alpha});
    }
}

// The floor below a ball, darkest under it: on the way out no step tells where the box ends.
TEST(PlacedGrids, NoBoxIsSeenOnTheFloor)
{
    const auto step_at_border = [](GridBorder border, float place) {
        const PlacedGrid ball{
            std::make_shared<const AoGrid>(sphere_grid(1.0, 3.0, 32, GridStore::cone, border)), {}};
        return std::abs(occlusion_at(ball, {place - 1e-3f, 0.0f, -1.0f}, {0, 0, 1}) -
                        occlusion_at(ball, {place + 1e-3f, 0.0f, -1.0f}, {0, 0, 1}));
    };
    for (const GridBorder border : {GridBorder::fade, GridBorder::rescale}) {
        EXPECT_LE(step_at_border(border, 3.0f), 1e-3f);
        EXPECT_LE(step_at_border(border, 2.64f), 1e-3f);
    }
}

TEST(PlacedGrids, JoinedConesHideTheirUnion)
{
    const auto cap = [](glm::vec3 axis, float cosine) {
        return glm::vec4(0.25f * (1.0f - cosine * cosine) * axis, 0.5f * (1.0f - cosine));
    };
    const glm::vec4 wide = cap({0, 0, 1}, 0.5f), narrow = cap({0, 0, 1}, 0.9f);
    const glm::vec4 aside = cap({1, 0, 0}, 0.9f);
    EXPECT_NEAR(merged(wide, narrow).w, wide.w, 1e-5f);
    EXPECT_NEAR(merged(wide, wide).z, wide.z, 1e-5f);
    EXPECT_NEAR(merged(wide, aside).w, wide.w + aside.w, 1e-5f);
    EXPECT_NEAR(merged(wide, aside).x, aside.x, 1e-5f);
    EXPECT_EQ(merged(aside, wide), merged(wide, aside));
    EXPECT_EQ(merged(glm::vec4(0.0f), wide), wide);
}

}  // namespace
}  // namespace surfelao
