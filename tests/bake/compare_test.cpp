#include "bake/compare.h"

#include "bake/frontier.h"
#include "files/scene_io.h"
#include "scenes.h"
#include "surfels/texels.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

using Json = nlohmann::json;

/// Quick: few rays everywhere, no cache, one round.
CompareSettings quick(const std::filesystem::path& input)
{
    CompareSettings settings;
    settings.input = input;
    settings.candidates.emplace_back().engine = Engine::disks;
    settings.rays = {4, 16, 64};
    settings.reference_rays = 512;
    settings.sample = 1000;
    settings.rounds = 1;
    settings.use_cache = false;
    return settings;
}

/// The same with a map.
CompareSettings quick_map(const std::filesystem::path& input)
{
    CompareSettings settings = quick(input);
    settings.texels.emplace().size = 64;
    settings.texels->uvs = UvChoice::made;
    return settings;
}

class Compare : public testing::Test {
protected:
    void SetUp() override { write_obj(folder_ / "in.obj", scenes::bumpy_sphere(8)); }
    TemporaryFolder folder_;
};

TEST_F(Compare, RowsComeInOrderAndMoreRaysAreMoreExact)
{
    const Comparison c = compare(quick(folder_ / "in.obj"));
    ASSERT_GE(c.rows.size(), 4u);
    EXPECT_EQ(c.rows[0].settings.engine, Engine::disks);
    EXPECT_EQ(c.rows[1].settings.rays, 4u);
    for (const std::size_t i : {1u, 2u}) {
        EXPECT_GT(c.rows[i].solve.rmse, c.rows[i + 1].solve.rmse);
        EXPECT_GT(c.rows[i].seen.rmse, c.rows[i + 1].seen.rmse);
        EXPECT_GT(c.rows[i].beyond, c.rows[i + 1].beyond);
    }
    EXPECT_EQ(c.points + c.ill_defined, 1000u);
    EXPECT_GT(c.receivers, c.triangles);
    for (const CompareRow& row : c.rows) {
        EXPECT_GT(row.solve_s, 0.0);
        EXPECT_GT(row.fit_s, 0.0);
        EXPECT_GT(row.us_per_receiver, 0.0);
        EXPECT_EQ(row.seen.count, c.points);
        EXPECT_EQ(row.solve.count, c.points);
        EXPECT_LE(row.seen.rmse, row.seen.max);
        ASSERT_FALSE(row.worst.empty());
        EXPECT_NEAR(std::fabs(row.worst[0].displayed - row.worst[0].reference), row.seen.max, 1e-6);
    }
    EXPECT_FALSE(c.rows[1].ratio);  // the opponent is not compared with itself
    ASSERT_TRUE(c.rows[0].ratio);
    EXPECT_GT(c.rows[0].ratio->ratio, 0.0);
}

// Nobody is below the floor, and what is beyond it adds up with it.
TEST_F(Compare, SquaresOfFloorAndBeyondAddUpToTheSeenError)
{
    using scenes::operator+;
    write_obj(folder_ / "room.obj",
              scenes::room({0, 0, 0}, {4, 3, 2}, 6) + scenes::box({1, 1, 0}, {2, 2, 1}, 2));
    CompareSettings settings = quick(folder_ / "room.obj");
    settings.max_distance = {20.0, true};
    settings.sample = 4000;
    const Comparison c = compare(settings);
    EXPECT_GT(c.floor.rmse, 0.01);
    for (const CompareRow& row : c.rows) {
        EXPECT_GT(row.seen.rmse, 0.99 * c.floor.rmse);
        EXPECT_NEAR(std::hypot(c.floor.rmse, row.beyond), row.seen.rmse, 0.03 * row.seen.rmse);
    }
    EXPECT_NEAR(beyond_by_squares(c, c.rows[1]), c.rows[1].beyond, 0.05 * c.rows[1].beyond);
}

// Values asked at the vertices themselves are held to the same floor.
TEST_F(Compare, ValuesOfPointsHaveTheFloorOfTheFit)
{
    CompareSettings settings = quick(folder_ / "in.obj");
    const Comparison fit = compare(settings);
    settings.target.values = VertexValues::point;
    const Comparison point = compare(settings);
    EXPECT_EQ(point.floor.rmse, fit.floor.rmse);
    EXPECT_LT(point.receivers, fit.receivers);
    EXPECT_GT(point.rows[3].beyond, fit.rows[3].beyond);  // 64 rays
}

TEST_F(Compare, NoiseOfTheReferenceIsStated)
{
    const Comparison c = compare(quick(folder_ / "in.obj"));
    EXPECT_GT(c.reference_noise, 0.0);
    EXPECT_LT(c.reference_noise, std::pow(512, -0.73));
    EXPECT_GT(c.floor_noise, 0.0);
    EXPECT_LT(c.floor_noise, c.reference_noise);  // the fit averages
    EXPECT_EQ(c.floor_rays, 512u);
}

// Two sheets as far apart as the offset: nobody is judged between them.
TEST_F(Compare, IllDefinedPointsAreLeftOutAndCounted)
{
    using scenes::operator+;
    const double gap = 1e-4 * std::sqrt(2.0);  // one offset
    write_obj(folder_ / "sheets.obj", scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4) +
                                          scenes::sheet({0, 0, gap}, {1, 0, 0}, {0, 1, 0}, 4));
    const Comparison c = compare(quick(folder_ / "sheets.obj"));
    EXPECT_EQ(c.ill_defined, 500u);  // the lower sheet's
    EXPECT_EQ(c.points, 500u);
    EXPECT_NE(table_of(c).find("500 ill-defined points left out (50.00 %)"), std::string::npos);
}

// A triangle without area in front counts in the scene, and nowhere else.
TEST_F(Compare, WorstPointsAreOnTheirTrianglesInTheFilesUnits)
{
    using scenes::operator+;
    const Scene wall = scenes::wall_and_floor(10.0, 2);
    write_obj(folder_ / "wall.obj", wall);
    write_obj(folder_ / "one_more.obj", scenes::triangle({9, 0, 0}, {9, 0, 0}, {9, 0, 0}) + wall);
    const Comparison c = compare(quick(folder_ / "wall.obj"));
    const Comparison more = compare(quick(folder_ / "one_more.obj"));
    for (std::size_t i = 0; i < 5; ++i) {
        const WorstPoint& worst = c.rows[0].worst.at(i);
        EXPECT_EQ(more.rows[0].worst.at(i).triangle, worst.triangle + 1);
        EXPECT_EQ(more.rows[0].worst.at(i).position, worst.position);
        const glm::uvec3 t = wall.triangles[worst.triangle];
        const std::vector<glm::dvec3>& p = wall.positions;
        const glm::dvec3 normal = glm::normalize(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
        EXPECT_NEAR(glm::dot(normal, worst.position - p[t.x]), 0.0, 1e-9);
        EXPECT_LT(glm::distance(worst.position, p[t.x]), 7.5);
    }
}

TEST_F(Compare, AddsARowOfRaysWhereACandidateIsMoreExact)
{
    CompareSettings settings = quick(folder_ / "in.obj");
    settings.rays = {1, 2};
    settings.rounds = 2;
    const Comparison c = compare(settings);  // disks beat 2 rays
    ASSERT_EQ(c.rows.size(), 4u);
    EXPECT_EQ(c.rows.back().settings.rays, 8u);
    EXPECT_EQ(c.rows.back().rounds, 1);
    EXPECT_EQ(c.rows.front().rounds, 2);
    EXPECT_EQ(Json::parse(json_of(c))["rows"][3]["rounds"], 1);
    EXPECT_NE(table_of(c).find("8 rays: ran once"), std::string::npos);
}

TEST_F(Compare, OpenScenesHaveNoRatioAndNoError)
{
    write_obj(folder_ / "sheet.obj", scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4));
    const Comparison c = compare(quick(folder_ / "sheet.obj"));
    for (const CompareRow& row : c.rows) {
        EXPECT_EQ(row.seen.rmse, 0.0);
        EXPECT_EQ(row.solve.rmse, 0.0);
        EXPECT_EQ(row.beyond, 0.0);
        EXPECT_FALSE(row.ratio);
    }
}

TEST_F(Compare, ReportsHaveTheirKeysAndColumns)
{
    const Comparison c = compare(quick(folder_ / "in.obj"));
    const Json json = Json::parse(json_of(c));
    EXPECT_EQ(json["reference"]["rays"], 512);
    EXPECT_TRUE(json["reference"].contains("noise"));
    ASSERT_EQ(json["rows"].size(), c.rows.size());
    EXPECT_EQ(json["reference"]["points"], c.points);
    EXPECT_EQ(json["floor"]["rmse"], c.floor.rmse);
    EXPECT_EQ(json["floor"]["rays"], 512);
    EXPECT_EQ(json["target"]["values"], "fit");
    for (const char* key : {"engine", "setting", "rounds", "build_s", "solve_s", "fit_s",
                            "us_per_receiver", "beyond", "beyond_by_squares", "embree_ratio"})
        EXPECT_TRUE(json["rows"][0].contains(key)) << key;
    for (const char* kind : {"seen", "solve"}) {
        for (const char* key : {"rmse", "bias", "p95", "max", "bent_mean_deg", "bent_p95_deg"})
            EXPECT_TRUE(json["rows"][0][kind].contains(key)) << kind << ' ' << key;
    }
    EXPECT_TRUE(json["rows"][1]["embree_ratio"].is_null());

    std::istringstream csv(csv_of(c));
    std::string line;
    std::size_t lines = 0;
    std::vector<long> commas;
    while (std::getline(csv, line)) {
        ++lines;
        bool quoted = false;
        commas.push_back(std::count_if(line.begin(), line.end(), [&](char character) {
            quoted ^= character == '"';
            return character == ',' && !quoted;
        }));
    }
    EXPECT_EQ(lines, c.rows.size() + 1);
    for (const long count : commas)
        EXPECT_EQ(count, commas.front());
    EXPECT_NE(table_of(c).find("surface error (seen) over 1000 points, floor 0."),
              std::string::npos);
}

// What is judged is the map that a bake would write, and the floor's is of another seed.
TEST_F(Compare, OfMapsJudgesWhatABakeWouldShow)
{
    const CompareSettings settings = quick_map(folder_ / "in.obj");
    const Comparison c = compare(settings);
    const MapLayout layout = layout_for(*c.mesh, *settings.texels).layout;
    const MapBake bake = bake_map(*c.mesh, layout, {.depth = MapDepth::whole, .check = 1000},
                                  c.rows[0].settings, {});
    std::size_t texels = 0;
    for (const UvSet& page : layout.pages)
        texels += MapRaster(c.mesh->geometry, page, layout.size).texels(0, 64).size();
    EXPECT_EQ(c.receivers, texels);
    EXPECT_GT(bake.receivers, texels);  // and samples beside steps
    ASSERT_EQ(c.rows[0].errors.size(), 64u * 64u);
    ASSERT_EQ(c.reference.size(), 64u * 64u);
    for (std::size_t i = 0; i < c.reference.size(); ++i)
        EXPECT_NEAR(c.reference[i] + c.rows[0].errors[i], 1.0f - bake.visibility[0].values[i],
                    1e-6);
    EXPECT_NEAR(c.rows[0].seen.rmse, bake.error->rmse, 0.1 * bake.error->rmse);

    EXPECT_GT(c.floor.rmse, 0.0);
    EXPECT_GT(c.floor_noise, 0.0);
    for (const std::size_t i : {1u, 2u}) {  // 4, 16 and 64 rays
        EXPECT_GT(c.rows[i].seen.rmse, c.rows[i + 1].seen.rmse);
        EXPECT_GT(c.rows[i].beyond, c.rows[i + 1].beyond);
    }
    for (const CompareRow& row : c.rows) {
        EXPECT_EQ(row.seen.count, c.points);
        // of 4 rays the noise makes steps, which are fitted away: .09 less than these two add up to
        EXPECT_NEAR(std::hypot(c.floor.rmse, row.beyond), row.seen.rmse, 0.1 * row.seen.rmse);
        EXPECT_GT(row.raster_s, 0.0);
        EXPECT_GT(row.fill_s, 0.0);
        EXPECT_EQ(row.fit_s, 0.0);
        EXPECT_DOUBLE_EQ(job_seconds(row, true), row.build_s + row.solve_s + row.fill_s);
    }
    EXPECT_TRUE(c.rows[0].ratio);
}

TEST_F(Compare, OfMapsLeavesOutWhatLiesInsideOfBodies)
{
    using scenes::operator+;
    write_obj(folder_ / "sunk.obj", scenes::sheet({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 8) +
                                        scenes::box({1.1, 1.1, -1.1}, {2.9, 2.9, 0.7}, 2));
    const Comparison map = compare(quick_map(folder_ / "sunk.obj"));
    EXPECT_NEAR(static_cast<double>(map.hidden), 1000.0 * 3.24 / 35.44, 5.0);  // of the sheet
    EXPECT_EQ(map.points + map.hidden + map.ill_defined, 1000u);
    EXPECT_EQ(compare(quick(folder_ / "sunk.obj")).hidden, 0u);
    EXPECT_NE(table_of(map).find(std::to_string(map.hidden) + " hidden ones"), std::string::npos);
}

TEST_F(Compare, ReportsOfMapsSayWhatTheyHold)
{
    Comparison c = compare(quick_map(folder_ / "in.obj"));
    const Json json = Json::parse(json_of(c));
    EXPECT_EQ(json["target"]["texels"]["width"], 64);
    EXPECT_TRUE(json["target"]["texels"]["uv_set"].is_null());
    EXPECT_TRUE(json["rows"][0]["seen"]["bent_mean_deg"].is_null());
    EXPECT_TRUE(json["rows"][0]["solve"]["bent_mean_deg"].is_number());
    EXPECT_EQ(json["rows"][0]["fill_s"], c.rows[0].fill_s);
    EXPECT_NE(table_of(c).find("64 x 64 texels (new texture coordinates)"), std::string::npos);
    EXPECT_NE(table_of(c).find("fill s"), std::string::npos);
    Frontier frontier;
    frontier.engines = {Engine::disks};
    frontier.scenes.push_back(frontier_scene(std::move(c)));
    EXPECT_EQ(frontier.scenes[0].pictures.size(), 2u);  // what rays say, and the error of disks
    EXPECT_NE(html_of(frontier).find("a map of 64 x 64 texels"), std::string::npos);
}

TEST_F(Compare, DifferenceFileIsTheSceneInColour)
{
    const Comparison c = compare(quick(folder_ / "in.obj"));
    write_difference(folder_ / "difference.ply", c, shown_row(c));
    const Scene scene = read_scene(folder_ / "difference.ply");
    EXPECT_EQ(scene.positions, c.mesh->scene.positions);
    EXPECT_EQ(scene.triangles, c.mesh->scene.triangles);
}

TEST_F(Compare, CanBeCancelledAtEveryStage)
{
    for (const std::string stop : {"read", "reference", "floor", "disks good", "rays 16 rays"}) {
        EXPECT_THROW(static_cast<void>(
                         compare(quick(folder_ / "in.obj"),
                                 [&](std::string_view stage, double) { return stage != stop; })),
                     Cancelled)
            << stop;
    }
}

}  // namespace
}  // namespace surfelao
