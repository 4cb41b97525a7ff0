#include "reference/smoothing.h"

#include "differences.h"
#include "reference/rays.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "tests/vertex_receivers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surfelao {
namespace {

TEST(Smoothing, AConstantStaysItself)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(8));
    std::vector<Occlusion> values;
    for (const glm::vec3 normal : geometry.normals)
        values.push_back({0.25f, normal});
    for (const Occlusion& o : smooth_occlusion(geometry, values))
        EXPECT_NEAR(o.occlusion, 0.25f, 1e-6f);
}

// A flat grid, one vertex at 1: it keeps 2 of 2 + 6 parts, each of its six neighbours gets 1 of 8.
TEST(Smoothing, SpreadsOneVertexOverItsRing)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4));
    std::vector<Occlusion> values(geometry.positions.size(), {0.0f, {0, 0, 1}});
    const std::size_t middle = values.size() / 2;
    values[middle].occlusion = 1.0f;
    const std::vector<Occlusion> smooth = smooth_occlusion(geometry, values);
    EXPECT_NEAR(smooth[middle].occlusion, 2.0f / 8.0f, 1e-6f);
    EXPECT_NEAR(smooth[middle + 1].occlusion, 1.0f / 8.0f, 1e-6f);
    EXPECT_EQ(smooth[0].occlusion, 0.0f);
}

TEST(Smoothing, TakesNoiseOfFewRaysAwayOnASmoothMesh)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(24));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    const RayScene scene(geometry, RayScene::Build::fast);
    RayOptions options;
    options.rays = 1024;
    const auto truth = trace_occlusion(scene, receivers, options);
    options.rays = 4;
    const auto noisy = trace_occlusion(scene, receivers, options);
    EXPECT_LT(rms_difference(smooth_occlusion(geometry, noisy), truth),
              0.7 * rms_difference(noisy, truth));
}

TEST(Smoothing, VerticesWithoutANormalKeepTheirValue)
{
    Scene scene = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    scene.positions.push_back({5, 5, 5});
    const Geometry geometry = make_geometry(scene);
    std::vector<Occlusion> values(5, {0.5f, {0, 0, 1}});
    values[4] = {};
    const std::vector<Occlusion> smooth = smooth_occlusion(geometry, values);
    EXPECT_EQ(smooth[4].occlusion, 0.0f);
    EXPECT_EQ(smooth[4].bent_normal, glm::vec3(0.0f));
}

TEST(Smoothing, AnotherNumberOfAnswersThanVerticesIsRefused)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    EXPECT_THROW(static_cast<void>(smooth_occlusion(geometry, std::vector<Occlusion>(3))),
                 SettingsError);
}

}  // namespace
}  // namespace surfelao
