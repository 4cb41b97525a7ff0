#include "bake/surface_error.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr glm::vec3 kAnyBent{0, 0, 1};

std::shared_ptr<const Mesh> mesh_of(Scene scene)
{
    return std::make_shared<const Mesh>(make_mesh(std::move(scene)));
}

TruthSettings quick(std::uint32_t rays, std::uint64_t points)
{
    TruthSettings settings;
    settings.rays = rays;
    settings.points = points;
    settings.use_cache = false;
    return settings;
}

std::vector<Occlusion> all(const Mesh& mesh, float occlusion)
{
    return std::vector<Occlusion>(mesh.scene.positions.size(), {occlusion, kAnyBent});
}

// Of 40,000 points each cell of 1/400 of the square holds 100: random ones would be 10 off, these
// are not by half of that.
TEST(SurfacePoints, AreUniformByArea)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1) +
                                            scenes::sheet({0, 0, 1}, {.5, 0, 0}, {0, .5, 0}, 3));
    std::map<std::pair<int, int>, int> cells;
    std::vector<int> counts(geometry.triangles.size(), 0);
    for (const SurfacePoint& point : surface_points(geometry, 50'000)) {
        ++counts[point.triangle];
        ASSERT_GE(point.at.x, 0.0f);
        ASSERT_GE(point.at.y, 0.0f);
        ASSERT_LE(point.at.x + point.at.y, 1.0f + 1e-6f);
        if (point.triangle >= 2)
            continue;
        const glm::uvec3 t = geometry.triangles[point.triangle];
        const glm::vec3 low = geometry.positions[0];
        const float side = geometry.positions[1].x - low.x;
        const glm::vec3 p = geometry.positions[t.x] +
                            point.at.x * (geometry.positions[t.y] - geometry.positions[t.x]) +
                            point.at.y * (geometry.positions[t.z] - geometry.positions[t.x]);
        ++cells[{static_cast<int>(20.0f * (p.x - low.x) / side),
                 static_cast<int>(20.0f * (p.y - low.y) / side)}];
    }
    for (std::size_t t = 0; t < counts.size(); ++t)
        EXPECT_NEAR(counts[t], t < 2 ? 20'000.0 : 10'000.0 / 18.0, 2.0) << t;
    double squares = 0.0;
    for (const auto& [cell, count] : cells)
        squares += std::pow(count - 100, 2);
    EXPECT_LT(std::sqrt(squares / 400.0), 5.0);
}

TEST(SurfacePoints, ThereAreNoneWithoutTriangles)
{
    const Mesh mesh;
    EXPECT_TRUE(surface_points(mesh.geometry, 100).empty());
    const SurfaceTruth truth = trace_truth(mesh, quick(2, 100));
    EXPECT_EQ(seen_error(mesh.geometry, all(mesh, 0.5f), truth).count, 0u);
}

// Nothing above a plane, everything around the inside of a box: exact truths.
TEST(SeenError, OfConstantsIsExactWhereTheTruthIs)
{
    const auto plane = mesh_of(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3));
    const SurfaceTruth open = trace_truth(*plane, quick(1024, 500));
    EXPECT_EQ(open.points.size(), 500u);
    EXPECT_EQ(open.noise, 0.0);
    EXPECT_EQ(seen_error(plane->geometry, all(*plane, 0.0f), open).rmse, 0.0);
    const ErrorStatistics quarter = seen_error(plane->geometry, all(*plane, 0.25f), open);
    EXPECT_NEAR(quarter.rmse, 0.25, 1e-6);
    EXPECT_NEAR(quarter.bias, 0.25, 1e-6);
    EXPECT_NEAR(quarter.max, 0.25, 1e-6);
    EXPECT_NEAR(quarter.bent_mean_deg, 0.0, 0.2);  // of so many rays

    const auto room = mesh_of(scenes::room({0, 0, 0}, {1, 2, 3}, 3));
    const SurfaceTruth closed = trace_truth(*room, quick(16, 500));
    EXPECT_NEAR(seen_error(room->geometry, all(*room, 1.0f), closed).rmse, 0.0, 1e-6);
    EXPECT_NEAR(seen_error(room->geometry, all(*room, 0.5f), closed).bias, -0.5, 1e-6);
}

TEST(SeenError, IsOfWhatIsInterpolated)
{
    const Geometry geometry = make_geometry(scenes::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    const std::vector<Occlusion> values = {{0.0f, {1, 0, 0}}, {0.4f, {0, 1, 0}}, {0.8f, {0, 1, 0}}};
    const SurfacePoint points[] = {{0, {0.25f, 0.25f}}};
    const Occlusion shown = displayed_at(geometry, values, points).front();
    EXPECT_NEAR(shown.occlusion, 0.3f, 1e-6f);
    EXPECT_NEAR(shown.bent_normal.x, std::sqrt(0.5f), 1e-6f);
    EXPECT_NEAR(shown.bent_normal.y, std::sqrt(0.5f), 1e-6f);
}

/// A box on the floor of a room, so coarse that vertices cannot hold its shadow. Near occluders
/// only: all of it would be closed.
class FloorOfARoom : public testing::Test {
protected:
    static TruthSettings near(std::uint32_t rays)
    {
        TruthSettings settings = quick(rays, 2000);
        settings.definition.max_distance = 0.3f;
        return settings;
    }
    Floor find(std::uint32_t rays) const { return find_floor(target_, *mesh_, truth_, near(rays)); }
    std::shared_ptr<const Mesh> mesh_ =
        mesh_of(scenes::room({0, 0, 0}, {4, 3, 2}, 3) + scenes::box({1, 1, 0}, {2, 2, 1}, 1));
    VertexTarget target_{mesh_, {}};
    SurfaceTruth truth_ = trace_truth(*mesh_, near(1024));
};

// The fit is the best there is: any other values are worse.
TEST_F(FloorOfARoom, IsBelowWhatOtherValuesShow)
{
    const Floor floor = find(256);
    EXPECT_EQ(floor.rays, 256u);
    EXPECT_GT(floor.error.rmse, 0.01);
    for (const float change : {-0.01f, 0.01f}) {
        for (const std::size_t step : {1u, 2u}) {
            std::vector<Occlusion> values = floor.values;
            for (std::size_t i = 0; i < values.size(); i += step)
                values[i].occlusion += change;
            EXPECT_GT(seen_error(mesh_->geometry, values, truth_).rmse, floor.error.rmse);
        }
    }
}

// Sixteen rays a receiver, their noise taken out, know the floor as well as a thousand: without
// that it would be a tenth higher.
TEST_F(FloorOfARoom, IsFreeOfItsNoise)
{
    const Floor few = find(16), many = find(1024);
    EXPECT_GT(few.noise, 4.0 * many.noise);
    EXPECT_NEAR(few.error.rmse, many.error.rmse, 0.02 * many.error.rmse);
    EXPECT_LT(error_beyond(few.displayed, many), 1.5 * few.noise);
    EXPECT_GT(error_beyond(few.displayed, many), few.noise / 1.5);
    EXPECT_EQ(error_beyond(many.displayed, many), 0.0);
}

}  // namespace
}  // namespace surfelao
