#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class PixelCompareCommand : public testing::Test {
protected:
    void SetUp() override { write_obj(folder_ / "a.obj", scenes::bumpy_sphere(6)); }
    /// Of small pictures.
    Outcome run(std::vector<std::string> arguments) const
    {
        const std::vector<std::string> always = {
            "compare", folder_ / "a.obj", "--at", "pixels",   "--width",
            "48",      "--height",        "36",   "--rounds", "1"};
        arguments.insert(arguments.begin(), always.begin(), always.end());
        return surfelao::run(folder_.path(), arguments);
    }
    TemporaryFolder folder_;
};

TEST_F(PixelCompareCommand, MakesTheTableAndAllFiles)
{
    const fs::path out = folder_ / "out";
    const Outcome outcome = run({"--engines",
                                 "masks,rays,gtao,hbao",
                                 "--qualities",
                                 "good",
                                 "--rays",
                                 "16",
                                 "--taps",
                                 "8,24",
                                 "--set",
                                 "hbao.bias=30",
                                 "--views",
                                 "2",
                                 "--max-distance",
                                 "20%",
                                 "--json",
                                 folder_ / "c.json",
                                 "--csv",
                                 folder_ / "c.csv",
                                 "-o",
                                 out});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* word : {"surface %", "whole %", "mean of 2 cameras",
                             "camera 2: azimuth=", "bias 30", "max distance 0.2", "wrote "})
        EXPECT_NE(outcome.out.find(word), std::string::npos) << word << '\n' << outcome.out;
    EXPECT_GT(fs::file_size(out / "report.html"), 1000u);
    EXPECT_FALSE(fs::exists(out / "difference.ply"));
    const std::string csv = contents_of(folder_ / "c.csv");
    EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 3 * 6);
    const Json json = Json::parse(contents_of(folder_ / "c.json"));
    std::vector<std::string> engines;
    for (const Json& row : json["means"])
        engines.push_back(row["engine"]);
    EXPECT_EQ(engines, (std::vector<std::string>{"masks", "rays", "gtao", "gtao", "hbao", "hbao"}));
    EXPECT_EQ(json["reference"]["rays"], 256);
    EXPECT_EQ(json["rows"][1]["setting"], "16 rays");
    EXPECT_LT(json["rows"][0]["rmse"], json["rows"][2]["rmse"]);
}

TEST_F(PixelCompareCommand, TunesOneSetting)
{
    const std::vector<std::string> tune = {"--tune", "hbao.bias=0:40:20", "--views", "1"};
    const Outcome table = run(tune);
    ASSERT_EQ(table.code, 0) << table.err;
    EXPECT_NE(table.out.find("<- best"), std::string::npos) << table.out;
    std::vector<std::string> with_json = tune;
    with_json.insert(with_json.end(), {"--json", "-"});
    const Json sweep = Json::parse(run(with_json).out)["sweep"];
    EXPECT_EQ(sweep["name"], "hbao.bias");
    ASSERT_EQ(sweep["values"].size(), 3u);
    EXPECT_EQ(sweep["values"][2]["value"], 40);
    double least = 1e9;
    for (const Json& value : sweep["values"])
        least = std::min(least, value["rmse"].get<double>());
    for (const Json& value : sweep["values"])
        EXPECT_EQ(value["rmse"] == least, value["value"] == sweep["best"]);
}

TEST_F(PixelCompareCommand, LooksFromTheCamerasThatAreNamed)
{
    const Outcome outcome =
        run({"--engines", "masks", "--qualities", "draft", "--camera", "azimuth=10", "--camera",
             "azimuth=100,elevation=80", "--json", "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json cameras = Json::parse(outcome.out)["cameras"];
    ASSERT_EQ(cameras.size(), 2u);
    EXPECT_EQ(cameras[1]["text"], "azimuth=100,elevation=80");
    const Outcome nothing = run({"--engines", "masks", "--camera", "eye=0:0:9,target=0:0:99"});
    EXPECT_EQ(nothing.code, 1);
    EXPECT_NE(nothing.err.find("nothing of the scene is seen"), std::string::npos) << nothing.err;
}

TEST_F(PixelCompareCommand, RefusesWhatDoesNotGoTogether)
{
    const std::vector<std::vector<std::string>> wrong = {
        {folder_ / "a.obj"},
        {"--frontier"},
        {"--sample", "100"},
        {"--subdivide"},
        {"--values", "point"},
        {"--views", "0"},
        {"--views", "2", "--camera", "azimuth=3"},
        {"--engines", "masks", "--rays", "16"},
        {"--engines", "masks", "--set", "gtao.power=1"},
        {"--engines", "gtao", "--set", "gtao.power=0"},
        {"--engines", "gtao", "--set", "bias=30"},
        {"--engines", "vo", "--taps", "7"},
        {"--engines", "gtao", "--ground", "lowest"},
        {"--engines", "rays", "--devices", "gpu"},
        {"--engines", "none"},
        {"--guard", "5"},
        {"--tune", "hbao.bias=0:40"},
        {"--tune", "hbao.bais=0:40:10"},
        {"--tune", "hbao.bias=0:90:10", "--engines", "hbao"},
        {"--tune", "hbao.bias=0:90:10", "--taps", "8,16"},
        {"--tune", "hbao.bias=0:100:50"},
        {"--reference-rays", "255"}};
    for (const auto& arguments : wrong) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments.front() << '\n' << outcome.err;
        EXPECT_FALSE(outcome.err.empty());
    }
}

TEST_F(PixelCompareCommand, WithoutPixelsItsOptionsAreRefused)
{
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"--engines", "gtao"},
                                               {"--engines", "rays"},
                                               {"--taps", "8"},
                                               {"--tune", "hbao.bias=0:40:5"},
                                               {"--camera", "azimuth=3"},
                                               {"--width", "100"},
                                               {"--at", "cubemaps"}}) {
        std::vector<std::string> all = {"compare", folder_ / "a.obj"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Outcome outcome = surfelao::run(folder_.path(), all);
        EXPECT_EQ(outcome.code, 2) << arguments.front() << '\n' << outcome.err;
    }
}

}  // namespace
}  // namespace surfelao
