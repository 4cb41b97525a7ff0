#include "image/image_file.h"
#include "program.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace surfelao {
namespace {

const std::string kRobot = std::string(SURFELAO_DATA_FOLDER) + "/robot.glb";

class GridCommand : public testing::Test {
protected:
    void SetUp() override
    {
        // the leak checker may die where Mesa's threads end while the program does
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    }
    Outcome render(std::vector<std::string> options, const std::string& output = "x.png") const
    {
        std::vector<std::string> words = {"render",    kRobot,   "-o",        folder_ / output,
                                          "--context", "osmesa", "--width",   "64",
                                          "--height",  "48",     "--samples", "2"};
        words.insert(words.end(), options.begin(), options.end());
        return run(folder_.path(), words);
    }
    TemporaryFolder folder_;
};

TEST_F(GridCommand, PlaysTheRobotWithGridsOfItsParts)
{
    const Outcome outcome = render(
        {"--at", "pixels", "--engine", "grid", "--frames", "0:1", "--fps", "2"}, "f.%02d.png");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("grid, product, rest good"), std::string::npos) << outcome.out;
    const Image first = read_image(folder_ / "f.00.png"), second = read_image(folder_ / "f.01.png");
    EXPECT_FALSE(std::ranges::equal(first.pixels, second.pixels));
}

TEST_F(GridCommand, ComparesGridsAtPixels)
{
    const Outcome outcome =
        run(folder_.path(),
            {"compare", kRobot,   "--at",     "pixels",  "--engines", "grid,masks", "--qualities",
             "good",    "--time", "0.3",      "--width", "64",        "--height",   "48",
             "--views", "1",      "--rounds", "1",       "--json",    "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out)["rows"];
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0]["engine"], "grid");
    EXPECT_LT(rows[0]["rmse"].get<double>(), 8.0);
    EXPECT_GT(rows[0]["rmse"].get<double>(), rows[1]["rmse"].get<double>());
}

TEST_F(GridCommand, RefusesWhatDoesNotGoTogether)
{
    EXPECT_EQ(render({"--engine", "grid"}).code, 2);
    EXPECT_EQ(render({"--at", "cubemaps", "--engine", "grid"}).code, 2);
    EXPECT_EQ(render({"--at", "pixels", "--grid", "head=x.aogrid.json"}).code, 2);
    EXPECT_EQ(render({"--at", "pixels", "--merge", "union"}).code, 2);
    EXPECT_EQ(render({"--at", "pixels", "--engine", "grid", "--grid", "=x"}).code, 2);
    EXPECT_EQ(render({"--at", "pixels", "--engine", "grid", "--rays", "9"}).code, 2);
    EXPECT_EQ(render({"--at", "pixels", "--engine", "grid", "--guard", "9%"}).code, 2);
    EXPECT_EQ(render({"--at", "pixels", "--engine", "grid", "--mode", "bent-normals"}).code, 2);
    EXPECT_EQ(run(folder_.path(), {"view", kRobot, "--at", "pixels", "--engine", "grid"}).code, 2);
    const Outcome missing =
        render({"--at", "pixels", "--engine", "grid", "--grid", "head=x.aogrid.json"});
    EXPECT_EQ(missing.code, 1);
    EXPECT_NE(missing.err.find("x.aogrid.json"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace surfelao
