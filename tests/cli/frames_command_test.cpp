// Frames of an animation, each a file.
#include "files/scene_io.h"
#include "image/image_file.h"
#include "program.h"
#include "temporary_folder.h"
#include "tests/files/gltf_maker.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

/// A square, and another that comes down upon it, from 4 to .25 above it within a second.
std::string falling_lid()
{
    test::GltfMaker maker = test::square();
    maker.add("nodes", {{"mesh", 0}});
    maker.document["nodes"][0]["name"] = "floor";
    maker.document["nodes"][1]["name"] = "lid";
    maker.document["scenes"][0]["nodes"] = {0, 1};
    const int times =
        maker.add_accessor(maker.add_view(test::bytes_of<float>({0, 1})), 5126, "SCALAR", 2);
    const int places = maker.add_vectors<float>({0, 0, 4, 0, 0, 0.25f});
    maker.document["animations"] = {
        {{"name", "fall"},
         {"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    return maker.glb();
}

class FramesCommand : public testing::Test {
protected:
    void SetUp() override { std::ofstream(folder_ / "lid.glb", std::ios::binary) << falling_lid(); }
    Outcome bake(const std::string& output, const Strings& more) const
    {
        Strings arguments = {"bake", folder_ / "lid.glb", "-o", folder_ / output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(folder_.path(), arguments);
    }
    TemporaryFolder folder_;
};

TEST_F(FramesCommand, EachIsAFileOfItsMoment)
{
    const Outcome outcome = bake("f.%03d.ply", {"--frames", "0:2", "--fps", "2", "--check", "0",
                                                "--json", folder_ / "report.json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const double heights[] = {4.0, 2.125, 0.25};
    for (int frame = 0; frame < 3; ++frame) {
        const Scene scene = read_scene(folder_ / ("f.00" + std::to_string(frame) + ".ply"));
        EXPECT_EQ(scene.positions.back().z, heights[frame]);
    }
    const auto report = nlohmann::json::parse(std::ifstream(folder_ / "report.json"));
    ASSERT_EQ(report.size(), 3u);
    EXPECT_LT(report[0]["mean_occlusion"], 0.05);
    EXPECT_GT(report[2]["mean_occlusion"], 0.2);
}

// The square below never moves: its frames tell what they took, and a second run finds them done.
TEST_F(FramesCommand, TellsWhatAFrameTookAndGoesOn)
{
    const Strings asked = {"--frames", "0:3", "--fps",  "2",
                           "--check",  "0",   "--json", folder_ / "report.json"};
    ASSERT_EQ(bake("f.%d.ply", asked).code, 0);
    const auto report = nlohmann::json::parse(std::ifstream(folder_ / "report.json"));
    ASSERT_EQ(report.size(), 4u);
    const char* const seconds[] = {"0", "0.5", "1", "1.5"};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& motion = report[i]["motion"];
        for (const char* key : {"pose", "place", "tree", "solve", "fit", "write"})
            EXPECT_TRUE(motion[key].is_number()) << key;
        EXPECT_LE(motion["bound"], 0.002);
        EXPECT_TRUE(report[i]["misfit"]["rms"].is_number());
        EXPECT_EQ(report[i]["notes"].back(),
                  std::string("the pose is that of animation 0 \"fall\" at ") + seconds[i] + " s");
    }
    EXPECT_EQ(report[0]["motion"]["solved"], report[0]["receivers"]);
    EXPECT_EQ(report[3]["motion"]["solved"], 0) << "nothing moves behind the last key";
    // behind the last key nothing moves
    const Scene last = read_scene(folder_ / "f.2.ply"), behind = read_scene(folder_ / "f.3.ply");
    EXPECT_EQ(last.positions, behind.positions);
    fs::remove(folder_ / "f.1.ply");
    Strings again = asked;
    again.emplace_back("--resume");
    ASSERT_EQ(bake("f.%d.ply", again).code, 0);
    const auto resumed = nlohmann::json::parse(std::ifstream(folder_ / "report.json"));
    EXPECT_TRUE(resumed[0].contains("skipped") && resumed[3].contains("skipped"));
    EXPECT_TRUE(resumed[1].contains("motion"));
}

// What a file that occludes says is told of a sequence too.
TEST_F(FramesCommand, KeepTheNotesOfOccluders)
{
    test::GltfMaker glass = test::square();
    glass.add("materials", {{"name", "Glass"}, {"alphaMode", "BLEND"}});
    glass.document["meshes"][0]["primitives"][0]["material"] = 0;
    std::ofstream(folder_ / "glass.glb", std::ios::binary) << glass.glb();
    const Outcome outcome = bake("f.%d.ply", {"--frames", "0:1", "--check", "0", "--occluders",
                                              folder_ / "glass.glb", "--json", "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const auto& frame : nlohmann::json::parse(outcome.out))
        EXPECT_NE(frame["notes"].dump().find("glass.glb: material Glass, which light goes through"),
                  std::string::npos)
            << frame["notes"];
}

// --time is of the animation that is baked: a file without one occludes as it stands.
TEST_F(FramesCommand, OccludersStandStill)
{
    std::ofstream(folder_ / "still.glb", std::ios::binary) << test::square().glb();
    for (const Strings& at :
         {Strings{"f.ply", "--time", "1"}, Strings{"f.%d.ply", "--frames", "0:1"}}) {
        Strings more(at.begin() + 1, at.end());
        more.insert(more.end(), {"--check", "0", "--occluders", folder_ / "still.glb"});
        const Outcome outcome = bake(at.front(), more);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
}

TEST_F(FramesCommand, AreCompared)
{
    const Strings asked = {"compare",
                           folder_ / "lid.glb",
                           "--frames",
                           "0:2",
                           "--fps",
                           "2",
                           "--engines",
                           "masks",
                           "--qualities",
                           "draft",
                           "--sample",
                           "100",
                           "--reference-rays",
                           "64"};
    Strings with_json = asked;
    with_json.insert(with_json.end(), {"--json", folder_ / "report.json"});
    const Outcome outcome = run(folder_.path(), with_json);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("3 frames"), std::string::npos);
    const auto report = nlohmann::json::parse(std::ifstream(folder_ / "report.json"));
    ASSERT_EQ(report["rows"].size(), 4u);
    EXPECT_EQ(report["rows"][0]["engine"], "masks");
    EXPECT_LT(report["rows"][0]["rmse"], 0.1);
    Strings at_pixels = asked;
    at_pixels.insert(at_pixels.end(), {"--at", "pixels"});
    EXPECT_EQ(run(folder_.path(), at_pixels).code, 2);
}

// A distance in percent is the same length in all frames.
TEST_F(FramesCommand, HaveOneFrameOfReference)
{
    const Strings measure = {"--check", "0", "--engine", "rays", "--max-distance", "10%"};
    const auto mean = [&](const std::string& output, Strings more) {
        more.insert(more.end(), measure.begin(), measure.end());
        more.insert(more.end(), {"--json", folder_ / "report.json"});
        EXPECT_EQ(bake(output, more).code, 0);
        const auto report = nlohmann::json::parse(std::ifstream(folder_ / "report.json"));
        return (report.is_array() ? report.back() : report)["mean_occlusion"].get<double>();
    };
    // alone the last frame's box is 1.4 wide, and 10 % of it do not reach the lid at .25; of all
    // frames together it is 4.2, and they do
    EXPECT_EQ(mean("one.ply", {"--time", "1"}), 0.0);
    EXPECT_GT(mean("all.%d.ply", {"--frames", "0:1", "--fps", "1"}), 0.1);
}

// The lower square stays where it is in the picture while the lid comes down.
TEST_F(FramesCommand, PicturesKeepTheCamera)
{
    for (const char* at : {"vertices", "pixels"}) {
        const Outcome outcome = run(folder_.path(), {"render",
                                                     folder_ / "lid.glb",
                                                     "-o",
                                                     folder_ / "f.%d.png",
                                                     "--frames",
                                                     "0:2",
                                                     "--fps",
                                                     "2",
                                                     "--at",
                                                     at,
                                                     "--mode",
                                                     "normals",
                                                     "--width",
                                                     "64",
                                                     "--height",
                                                     "64",
                                                     "--context",
                                                     "osmesa",
                                                     "--no-ground",
                                                     "--up",
                                                     "z"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Image first = read_image(folder_ / "f.0.png"), last = read_image(folder_ / "f.2.png");
        int covered = 0, lower_first = 0, lower_last = 0;
        for (int y = 32; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const bool is_first = first.at(x, y) != first.at(0, 0);
                const bool is_last = last.at(x, y) != last.at(0, 0);
                covered += is_first && is_last ? 1 : 0;
                lower_first += is_first ? 1 : 0;
                lower_last += is_last ? 1 : 0;
            }
        }
        EXPECT_GT(lower_first, 50);
        EXPECT_EQ(covered, lower_first);  // where the square was seen it is seen, or the lid is
        EXPECT_GE(lower_last, lower_first);
    }
}

// A scene that is kept from frame to frame shows what rays show in each frame by itself.
TEST_F(FramesCommand, PicturesShowEachMoment)
{
    const auto pictures = [&](const std::string& mode) {
        const Outcome outcome = run(folder_.path(), {"render",     folder_ / "lid.glb",
                                                     "-o",         folder_ / "f.%d.png",
                                                     "--frames",   "0:1",
                                                     "--fps",      "1",
                                                     "--mode",     mode,
                                                     "--width",    "64",
                                                     "--height",   "64",
                                                     "--samples",  "1",
                                                     "--context",  "osmesa",
                                                     "--up",       "z",
                                                     "--no-ground"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return std::array{read_image(folder_ / "f.0.png"), read_image(folder_ / "f.1.png")};
    };
    const auto difference = [](const Image& a, const Image& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::abs(static_cast<double>(a.pixels[i].x - b.pixels[i].x));
        return sum / static_cast<double>(a.pixels.size());
    };
    const auto kept = pictures("visibility"), alone = pictures("rays");
    const double moved = difference(kept[0], kept[1]);
    for (std::size_t frame = 0; frame < 2; ++frame)
        EXPECT_LT(difference(kept[frame], alone[frame]), 0.1 * moved) << frame;
}

TEST_F(FramesCommand, RefusesWhatItCannotMean)
{
    EXPECT_EQ(bake("f.ply", {"--frames", "0:2"}).code, 2);
    EXPECT_EQ(bake("f.%d.ply", {"--frames", "2:1"}).code, 2);
    EXPECT_EQ(bake("f.%d.ply", {"--frames", "0:1", "--time", "3"}).code, 2);
    EXPECT_EQ(bake("f.%d.ply", {"--fps", "3"}).code, 2);
    // what a bake of one moment refuses
    const Strings two = {"--frames", "0:1"};
    const auto code = [&](Strings more) {
        more.insert(more.begin(), two.begin(), two.end());
        const Outcome outcome = bake("f.%d.ply", more);
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
        return outcome.code;
    };
    EXPECT_EQ(code({"--at", "points"}), 2);
    EXPECT_EQ(code({"--viewpoint", "0:0:0"}), 2);
    EXPECT_EQ(code({"--normals", "up"}), 2);
    EXPECT_EQ(code({"--exclude", "*"}), 1);
    folder_.file("cloud.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n0 0 0\n");
    EXPECT_EQ(code({"--occluders", folder_ / "cloud.ply"}), 1);
    fs::remove(folder_ / "cloud.ply");
    for (const Strings& more : {Strings{"--rounds", "2"}, Strings{"--no-cache"}}) {
        Strings arguments = {"compare", folder_ / "lid.glb", "--frames", "0:1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(run(folder_.path(), arguments).code, 2) << more.front();
    }
    EXPECT_EQ(run(folder_.path(),
                  {"render", folder_ / "lid.glb", "-o", folder_ / "f.%d.xyz", "--frames", "0:1"})
                  .code,
              1);
    const Outcome other = bake("f.%d.ply", {"--frames", "0:1", "--animation", "rise"});
    EXPECT_EQ(other.code, 1);
    EXPECT_NE(other.err.find("has no animation \"rise\", but \"fall\""), std::string::npos);
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        files += entry.path().extension() == ".ply" ? 1 : 0;
    EXPECT_EQ(files, 0u);
}

}  // namespace
}  // namespace surfelao
