#include "bake/compare.h"

#include "files/scene_io.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
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
    settings.smoothed_rays = {16};
    settings.reference_rays = 512;
    settings.rounds = 1;
    settings.use_cache = false;
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
    ASSERT_EQ(c.rows.size(), 6u);  // the last because the disks are more exact than 64 rays
    EXPECT_EQ(c.rows[5].settings.rays, 256u);
    EXPECT_EQ(c.rows[0].settings.engine, Engine::disks);
    EXPECT_TRUE(c.rows[4].smoothed);
    EXPECT_GT(c.rows[1].error.rmse, c.rows[2].error.rmse);
    EXPECT_GT(c.rows[2].error.rmse, c.rows[3].error.rmse);
    EXPECT_LT(c.rows[3].error.rmse, 0.05);
    EXPECT_EQ(c.judged + c.ill_defined + c.without_normal, c.vertices);
    for (const CompareRow& row : c.rows) {
        EXPECT_GT(row.solve_s, 0.0);
        EXPECT_GT(row.us_per_vertex, 0.0);
        EXPECT_LE(row.error.rmse, row.error.max);
        EXPECT_LE(std::fabs(row.error.bias), row.error.rmse + 1e-12);
        ASSERT_FALSE(row.worst.empty());
        EXPECT_NEAR(std::fabs(row.worst[0].occlusion - row.worst[0].reference), row.error.max,
                    1e-6);
    }
    EXPECT_FALSE(c.rows[1].solve_ratio);  // the opponent is not compared with itself
    ASSERT_TRUE(c.rows[0].solve_ratio && c.rows[4].solve_ratio);
    EXPECT_GT(c.rows[0].solve_ratio->ratio, 0.0);
}

TEST_F(Compare, NoiseOfTheReferenceIsStated)
{
    const Comparison c = compare(quick(folder_ / "in.obj"));
    EXPECT_GT(c.reference_noise, 0.0);
    EXPECT_LT(c.reference_noise, std::pow(512, -0.73));
}

TEST_F(Compare, ErrorsAreAtTheJudgedVerticesOnly)
{
    CompareSettings settings = quick(folder_ / "in.obj");
    settings.sample = 50;
    const Comparison c = compare(settings);
    EXPECT_EQ(c.judged + c.ill_defined + c.without_normal, 50u);
    const std::vector<float>& errors = c.rows[0].errors;
    ASSERT_EQ(errors.size(), c.vertices);
    EXPECT_EQ(static_cast<std::uint64_t>(std::count_if(errors.begin(), errors.end(),
                                                       [](float e) { return !std::isnan(e); })),
              c.judged);
}

// Two sheets as far apart as the offset: nobody is judged between them.
TEST_F(Compare, IllDefinedVerticesAreLeftOutAndCounted)
{
    using scenes::operator+;
    const double gap = 1e-4 * std::sqrt(2.0);  // one offset
    write_obj(folder_ / "sheets.obj", scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4) +
                                          scenes::sheet({0, 0, gap}, {1, 0, 0}, {0, 1, 0}, 4));
    const Comparison c = compare(quick(folder_ / "sheets.obj"));
    EXPECT_EQ(c.ill_defined, 25u);  // the lower sheet's
    EXPECT_EQ(c.judged, 25u);
}

TEST_F(Compare, AddsARowOfRaysWhereACandidateIsMoreExact)
{
    CompareSettings settings = quick(folder_ / "in.obj");
    settings.rays = {1, 2};
    settings.rounds = 2;
    const Comparison c = compare(settings);  // disks beat 2 rays
    ASSERT_EQ(c.rows.size(), 5u);
    EXPECT_EQ(c.rows.back().settings.rays, 8u);
    EXPECT_EQ(c.rows.back().rounds, 1);
    EXPECT_EQ(c.rows.front().rounds, 2);
    EXPECT_EQ(Json::parse(json_of(c))["rows"][4]["rounds"], 1);
    EXPECT_NE(table_of(c).find("8 rays ran once"), std::string::npos);
}

TEST_F(Compare, OpenScenesHaveNoRatioAndNoError)
{
    write_obj(folder_ / "sheet.obj", scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4));
    const Comparison c = compare(quick(folder_ / "sheet.obj"));
    for (const CompareRow& row : c.rows) {
        EXPECT_EQ(row.error.rmse, 0.0);
        EXPECT_FALSE(row.solve_ratio);
    }
}

TEST_F(Compare, ReportsHaveTheirKeysAndColumns)
{
    const Comparison c = compare(quick(folder_ / "in.obj"));
    const Json json = Json::parse(json_of(c));
    EXPECT_EQ(json["reference"]["rays"], 512);
    EXPECT_TRUE(json["reference"].contains("noise"));
    ASSERT_EQ(json["rows"].size(), c.rows.size());
    for (const char* key : {"engine", "setting", "rounds", "build_s", "solve_s", "us_per_vertex",
                            "rmse", "bias", "p95", "max", "embree_ratio"})
        EXPECT_TRUE(json["rows"][0].contains(key)) << key;
    EXPECT_TRUE(json["rows"][1]["embree_ratio"].is_null());
    EXPECT_EQ(json["rows"][1]["settings"]["smoothed"], false);
    EXPECT_EQ(json["rows"][4]["settings"]["smoothed"], true);
    EXPECT_FALSE(json["rows"][0]["settings"].contains("smoothed"));

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
    EXPECT_NE(table_of(c).find("noise"), std::string::npos);
}

TEST_F(Compare, DifferenceFileIsTheSceneInColour)
{
    const Comparison c = compare(quick(folder_ / "in.obj"));
    write_difference(folder_ / "difference.ply", c, shown_row(c));
    const Scene scene = read_scene(folder_ / "difference.ply");
    EXPECT_EQ(scene.positions, c.scene.positions);
    EXPECT_EQ(scene.triangles, c.scene.triangles);
}

TEST_F(Compare, CanBeCancelledAtEveryStage)
{
    for (const std::string stop : {"read", "reference", "disks good", "rays 16 rays"}) {
        EXPECT_THROW(static_cast<void>(
                         compare(quick(folder_ / "in.obj"),
                                 [&](std::string_view stage, double) { return stage != stop; })),
                     Cancelled)
            << stop;
    }
}

}  // namespace
}  // namespace surfelao
