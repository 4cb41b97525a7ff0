#include "bake/frontier.h"

#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace surfelao {
namespace {

using Json = nlohmann::json;

CompareRow row(Engine engine, double beyond, double seconds)
{
    CompareRow result;
    result.settings.engine = engine;
    result.beyond = beyond;
    result.seen.rmse = 0.5;  // which does not tell who is faster
    result.solve_s = 0.75 * seconds;
    result.fit_s = 0.25 * seconds;
    result.build_s = 1.0;
    return result;
}

/// Embree: error 0.1 / seconds. Ours: the same `faster` times quicker, between two errors.
FrontierScene made_up_scene(double faster, double coarse, double fine)
{
    FrontierScene scene;
    Comparison& c = scene.comparison.emplace();
    for (const double beyond : {0.1, 0.01, 0.001})
        c.rows.push_back(row(Engine::rays, beyond, 0.1 / beyond));
    for (const double beyond : {coarse, fine})
        c.rows.push_back(row(Engine::disks, beyond, 0.1 / beyond / faster));
    return scene;
}

TEST(Frontier, RatioIsTheirTimeOverOursAtEqualError)
{
    const FrontierScene scene = made_up_scene(4.0, 0.05, 0.002);
    for (const double beyond : kTargets) {
        const auto ratio = ratio_at(*scene.comparison, Engine::disks, beyond, Cost::solve);
        ASSERT_TRUE(ratio);
        EXPECT_NEAR(ratio->ratio, 4.0, 1e-9);
        EXPECT_FALSE(ratio->extrapolated);
    }
    // a second of building each, interpolated with it
    const auto built = ratio_at(*scene.comparison, Engine::disks, 0.01, Cost::build);
    ASSERT_TRUE(built);
    EXPECT_GT(built->ratio, 2.0);
    EXPECT_LT(built->ratio, 4.0);
}

TEST(Frontier, WhatAFamilyDoesNotReachIsExtrapolatedAndLeftOut)
{
    Frontier frontier;
    frontier.engines = {Engine::disks};
    frontier.scenes.push_back(made_up_scene(4.0, 0.05, 0.002));
    frontier.scenes.push_back(made_up_scene(8.0, 0.05, 0.002));
    frontier.scenes.push_back(made_up_scene(100.0, 0.05, 0.02));  // never at 0.010
    frontier.scenes.emplace_back().error = "bad.obj: refused";
    const RatioSummary summary = summary_of(frontier, Engine::disks, 0.010, Cost::solve);
    EXPECT_EQ(summary.scenes, 2u);
    EXPECT_EQ(summary.left_out, 1u);
    EXPECT_NEAR(summary.median, 6.0, 1e-9);
    EXPECT_NEAR(summary.worst, 4.0, 1e-9);
    EXPECT_NEAR(summary.best, 8.0, 1e-9);
}

// The median of the easy scenes is no median.
TEST(Frontier, AnErrorThatIsReachedOnFewScenesHasNoMedian)
{
    Frontier frontier;
    frontier.engines = {Engine::disks};
    for (const double fine : {0.002, 0.002, 0.02})
        frontier.scenes.push_back(made_up_scene(4.0, 0.05, fine));
    const auto summary = [&] { return summary_of(frontier, Engine::disks, 0.010, Cost::solve); };
    EXPECT_TRUE(stands_for_all(summary()));
    EXPECT_NE(html_of(frontier).find("<td>2 of 3</td><td>4.00</td>"), std::string::npos);
    frontier.scenes.push_back(made_up_scene(4.0, 0.05, 0.02));
    EXPECT_FALSE(stands_for_all(summary()));
    EXPECT_NE(html_of(frontier).find("<td>2 of 4</td><td>-</td>"), std::string::npos);
    const Json few = Json::parse(json_of(frontier))["summary"]["at_010"];
    EXPECT_TRUE(few["median_ratio"].is_null());
    EXPECT_EQ(few["scenes"], 2);
    EXPECT_EQ(few["left_out"], 2);
    EXPECT_NE(table_of(frontier).find("reached on"), std::string::npos);
}

// More exact than asked at every setting: the cheapest one's time, and that is no extrapolation.
TEST(Frontier, AFamilyBeyondTheTargetCountsAtItsCheapest)
{
    const FrontierScene scene = made_up_scene(4.0, 0.005, 0.002);
    const auto ratio = ratio_at(*scene.comparison, Engine::disks, 0.010, Cost::solve);
    ASSERT_TRUE(ratio);
    EXPECT_FALSE(ratio->extrapolated);
    EXPECT_NEAR(ratio->ratio, 10.0 / (0.1 / 0.005 / 4.0), 1e-9);
}

// The same for the opponent: one ray a receiver, fitted on a coarse mesh, may be exact enough.
TEST(Frontier, AnOpponentBeyondTheTargetCountsAtItsCheapest)
{
    FrontierScene scene = made_up_scene(4.0, 0.05, 0.002);
    std::erase_if(scene.comparison->rows, [](const CompareRow& r) {
        return r.settings.engine == Engine::rays && r.beyond > 0.005;
    });
    const auto ratio = ratio_at(*scene.comparison, Engine::disks, 0.010, Cost::solve);
    ASSERT_TRUE(ratio);
    EXPECT_FALSE(ratio->extrapolated);
    EXPECT_NEAR(ratio->ratio, (0.1 / 0.001) / (0.1 / 0.010 / 4.0), 1e-9);
}

TEST(Frontier, NoScenesGiveNullsAndNoCrash)
{
    Frontier frontier;
    frontier.engines = {Engine::disks};
    const Json json = Json::parse(json_of(frontier));
    EXPECT_TRUE(json["summary"]["at_010"]["median_ratio"].is_null());
    EXPECT_NE(table_of(frontier).find("MEDIAN"), std::string::npos);
}

TEST(FrontierSlow, RealScenesGiveAllReportsAndBadOnesDoNotStopThem)
{
    const TemporaryFolder folder;
    write_obj(folder / "a.obj", scenes::bumpy_sphere(8));
    write_obj(folder / "b.obj", scenes::nested_shells(2, 0.2, 6));
    FrontierSettings settings;
    settings.inputs = {folder / "a.obj", folder / "none.obj", folder / "b.obj"};
    settings.engines = {Engine::disks};
    settings.compare.rounds = 1;
    settings.compare.reference_rays = 1024;
    settings.compare.sample = 1000;
    settings.compare.use_cache = false;
    const Frontier result = frontier(settings);
    ASSERT_EQ(result.scenes.size(), 3u);
    EXPECT_FALSE(result.scenes[1].comparison);
    EXPECT_NE(result.scenes[1].error.find("none.obj"), std::string::npos);

    const Json json = Json::parse(json_of(result));
    for (const char* key : {"median_ratio", "worst_ratio", "quartiles"}) {
        EXPECT_TRUE(json["summary"]["at_010"].contains(key)) << key;
        EXPECT_TRUE(json["summary"]["with_builds"]["at_005"].contains(key)) << key;
    }
    ASSERT_EQ(json["scenes"].size(), 3u);
    EXPECT_EQ(json["scenes"][0]["reference"]["points"], 1000);
    EXPECT_TRUE(json["scenes"][0]["ratios"]["disks"].contains("at_010"));
    EXPECT_EQ(result.scenes[0].comparison->rows[5].settings.rays, 1u);
    EXPECT_TRUE(json["scenes"][1].contains("error"));

    const std::string html = html_of(result);
    for (const char* part :
         {"<svg", "data:image/png;base64,", "worst point", "Summary", "none.obj", "</html>"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_EQ(html.find("http"), std::string::npos);  // nothing is fetched from anywhere
    EXPECT_EQ(result.scenes[0].comparison->rows[0].errors.size(), 0u);  // memory is given back
}

}  // namespace
}  // namespace surfelao
