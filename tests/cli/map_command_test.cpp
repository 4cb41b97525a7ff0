#include "image/image_file.h"
#include "program.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace surfelao {
namespace {

using Json = nlohmann::json;

/// Two walls that meet at a right angle, each a half of the map; v runs up in the file.
constexpr const char* kCorner =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n"
    "vt 0.5 0\nvt 1 0\nvt 1 1\nvt 0.5 1\nvt 0 0\nvt 0 1\n"
    "f 1/1 2/2 3/3 4/4\nf 1/1 4/4 6/6 5/5\n";

class MapCommand : public testing::Test {
protected:
    Outcome bake(const std::vector<std::string>& options) const
    {
        std::vector<std::string> arguments = {"bake", folder_.file("in.obj", kCorner)};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run(folder_.path(), arguments);
    }
    /// What the file holds, 0 to 1.
    float stored(const char* name, int x, int y) const
    {
        return srgb_encode(read_image(folder_ / name).at(x, y).r);
    }
    TemporaryFolder folder_;
};

// Darkest at the edge, which is the middle of the map; and the same in all engines.
TEST_F(MapCommand, WritesAMapOverTheFilesCoordinates)
{
    for (const char* engine : {"masks", "rays"}) {
        const Outcome outcome = bake({"-o", folder_ / "ao.png", "--size", "32", "--engine", engine,
                                      "--bent", "world", "--json", folder_ / "report.json"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Image image = read_image(folder_ / "ao.png");
        ASSERT_EQ(image.width, 32);
        EXPECT_NEAR(stored("ao.png", 15, 16), 0.52f, 0.04f);  // half of what is seen is wall
        EXPECT_GT(stored("ao.png", 0, 16), 0.85f);
        EXPECT_GT(stored("ao.png", 31, 16), 0.85f);
        EXPECT_NEAR(stored("ao.png", 10, 16), stored("ao.png", 21, 16), 0.02f);
        EXPECT_TRUE(std::filesystem::exists(folder_ / "ao.bent.png"));
        const Json json = Json::parse(contents_of(folder_ / "report.json"));
        EXPECT_EQ(json["texels"]["covered"], 1024);
        EXPECT_EQ(json["texels"]["uv_set"], 0);
        EXPECT_LT(json["error"]["rmse"], 0.03);
        EXPECT_NE(outcome.out.find("wrote " + (folder_ / "ao.bent.png").string()),
                  std::string::npos)
            << outcome.out;
    }
}

TEST_F(MapCommand, RefusesWhatItCannotDo)
{
    folder_.file("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    // the corner's walls on one place, dark on one side and bright on the other
    folder_.file("twice.obj",
                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n"
                 "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                 "f 1/1 2/2 3/3 4/4\nf 1/2 4/3 6/4 5/1\n");
    folder_.file("bricks.obj",
                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 9 0\nvt 0 9\nf 1/1 2/2 3/3\n");
    struct Case {
        std::vector<std::string> options;
        int code;
        const char* says;
    };
    for (const Case& wrong :
         {Case{{"in.obj", "-o", "x.png", "--uv", "1"}, 1, "no texture coordinates of number 1"},
          {{"plain.obj", "-o", "x.png"}, 1, "no texture coordinates for a map"},
          {{"twice.obj", "-o", "x.png"}, 1, "are for other maps"},
          {{"bricks.obj", "-o", "x.png"}, 1, "times over"},
          {{"in.obj", "-o", "x.off", "--at", "texels"}, 1, "a map goes into"},
          {{"in.obj", "-o", "x.obj", "--at", "texels", "--charts", "blended"}, 1, "into .glb"},
          {{"in.obj", "-o", "x.png", "--size", "0"}, 2, "--size"},
          {{"in.obj", "-o", "x.png", "--size", "65536"}, 2, "--size"},
          {{"in.obj", "-o", "x.png", "--depth", "32"}, 1, "8 or 16 bits"},
          {{"in.obj", "-o", "x.ply", "--size", "64"}, 2, "Options of maps"},
          {{"in.obj", "-o", "x.png", "--uv", "new"}, 2, "--uv new"},
          {{"in.obj", "-o", "x.png", "--texels-per-unit", "9"}, 2, "--texels-per-unit"},
          {{"in.obj", "-o", "x.png", "--green", "-y"}, 2, "--bent tangent"},
          {{"in.obj", "-o", "x.png", "--cage", "1%"}, 2, "--high"},
          {{"in.obj", "-o", "x.png", "--high", "none.obj"}, 1, "none.obj"},
          {{"in.obj", "-o", "x.png", "--resume", "--udim"}, 2, "--udim"}}) {
        folder_.file("in.obj", kCorner);
        std::vector<std::string> arguments = {"bake"};
        for (const std::string& word : wrong.options)
            arguments.push_back(word.find('.') != word.npos && word != "1%"
                                    ? (folder_.path() / word).string()
                                    : word);
        const Outcome outcome = run(folder_.path(), arguments);
        EXPECT_EQ(outcome.code, wrong.code) << outcome.err;
        EXPECT_NE(outcome.err.find(wrong.says), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "x.png"));
    }
}

}  // namespace
}  // namespace surfelao
