// The commands on a file of points.
#include "image/image_file.h"
#include "program.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

namespace surfelao {
namespace {

using Json = nlohmann::json;

/// A ball of points, as text without names.
std::string ball()
{
    std::string text;
    for (int i = 0; i < 400; ++i) {
        const double z = (i + 0.5) / 200.0 - 1.0, a = 2.39996 * i, r = std::sqrt(1.0 - z * z);
        text += std::to_string(r * std::cos(a)) + ' ' + std::to_string(r * std::sin(a)) + ' ' +
                std::to_string(z) + '\n';
    }
    return text;
}

class CloudCommand : public testing::Test {
protected:
    Outcome run(std::vector<std::string> arguments) const
    {
        return surfelao::run(folder_.path(), arguments);
    }
    TemporaryFolder folder_;
    std::string cloud_ = folder_.file("ball.xyz", ball());
};

TEST_F(CloudCommand, BakesFromPointsToPoints)
{
    const std::string out = folder_ / "out.ply";
    const Outcome outcome = run({"bake", cloud_, "-o", out, "--at", "points", "--viewpoint",
                                 "9:0:0", "--check", "50", "--json", "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["points"]["occluders"], 400);
    EXPECT_EQ(json["points"]["orientation"], "viewpoint");
    EXPECT_EQ(json["settings"]["viewpoint"], Json({9.0, 0.0, 0.0}));
    EXPECT_EQ(json["receivers"], 400);
    EXPECT_EQ(json["error"]["points"], 50);
    EXPECT_NE(
        run({"bake", cloud_, "-o", out, "--viewpoint", "9:0:0", "--resume"}).out.find("skipped"),
        std::string::npos);
}

TEST_F(CloudCommand, TheOtherCommandsKnowPoints)
{
    const Outcome info = run({"info", cloud_});
    EXPECT_NE(info.out.find("400 points, no faces"), std::string::npos) << info.out << info.err;
    const Outcome compare = run({"compare", cloud_, "--engines", "masks,disks", "--qualities",
                                 "good", "--rounds", "1", "--sample", "100", "--reference-rays",
                                 "64", "--no-cache", "--json", "-", "-o", folder_ / "made/"});
    ASSERT_EQ(compare.code, 0) << compare.err;
    const Json json = Json::parse(compare.out);
    EXPECT_EQ(json["cloud"]["occluders"], 400);
    EXPECT_EQ(json["reference"]["points"], 100);
    EXPECT_LT(json["rows"][0]["seen"]["rmse"], 0.05);
}

TEST_F(CloudCommand, WhatIsForMeshesIsRefusedAndTheOtherWayRound)
{
    const std::string mesh = folder_.file("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string out = folder_ / "out.ply";
    for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
             {"bake", mesh, "-o", out, "--at", "points"},
             {"bake", mesh, "-o", out, "--viewpoint", "1:2:3"},
             {"bake", mesh, "-o", out, "--occluder-spacing", "1%"},
             {"bake", mesh, "-o", out, "--normals", "up"},
             {"bake", cloud_, "-o", out, "--at", "vertices"},
             {"bake", cloud_, "-o", out, "--at", "texels"},
             {"bake", cloud_, "-o", folder_ / "out.png"},
             {"bake", cloud_, "-o", out, "--normals", "flat"},
             {"bake", cloud_, "-o", out, "--viewpoint", "1:2"},
             {"bake", cloud_, "-o", out, "--viewpoint", "1:2:x"},
             {"bake", cloud_, "-o", out, "--viewpoint", "1:2:3:4"},
             {"bake", cloud_, "-o", out, "--occluder-spacing", "0"}}) {
        const Outcome outcome = run(wrong);
        EXPECT_EQ(outcome.code, 2) << wrong[1] << ' ' << wrong.back() << ' ' << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(out));
    }
}

}  // namespace
}  // namespace surfelao
