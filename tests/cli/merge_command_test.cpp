// Shares of a bake, each a run of the program, and what `merge` makes of them.
#include "files/scene_io.h"
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "tests/files/gltf_maker.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <glm/vec3.hpp>

#include <fstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

using Strings = std::vector<std::string>;

/// A sphere inside of another.
std::string shells_as_glb()
{
    const Scene scene = scenes::nested_shells(2, 0.2, 6);
    const std::vector<glm::vec3> positions(scene.positions.begin(), scene.positions.end());
    const auto bytes = [](const auto& values) {
        return std::string_view(reinterpret_cast<const char*>(values.data()),
                                values.size() * sizeof(values[0]));
    };
    test::GltfMaker maker;
    const int places =
        maker.add_accessor(maker.add_view(bytes(positions)), 5126, "VEC3", positions.size());
    const int corners = maker.add_accessor(maker.add_view(bytes(scene.triangles)), 5125, "SCALAR",
                                           3 * scene.triangles.size());
    maker.add("meshes",
              {{"primitives", {{{"attributes", {{"POSITION", places}}}, {"indices", corners}}}}});
    maker.add("nodes", {{"mesh", 0}});
    return maker.glb();
}

class MergeCommand : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::nested_shells(2, 0.2, 6));
        std::ofstream(folder_ / "a.glb", std::ios::binary) << shells_as_glb();
    }
    Outcome run(const Strings& arguments) const { return surfelao::run(folder_.path(), arguments); }
    Outcome bake(const std::string& input, const std::string& output, const Strings& more) const
    {
        Strings arguments = {"bake", folder_ / input, "-o", folder_ / output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    std::string part(const std::string& output, int share, int shares) const
    {
        return folder_ /
               (output + "." + std::to_string(share) + "-of-" + std::to_string(shares) + ".part");
    }
    Strings bake_parts(const std::string& input, const std::string& output, int shares,
                       const Strings& more = {}) const
    {
        Strings parts;
        for (int share = shares; share >= 1; --share) {  // any order will do
            Strings arguments = more;
            arguments.insert(arguments.end(),
                             {"--part", std::to_string(share) + "/" + std::to_string(shares)});
            const Outcome outcome = bake(input, output, arguments);
            EXPECT_EQ(outcome.code, 0) << outcome.err;
            EXPECT_FALSE(fs::exists(folder_ / output));
            parts.push_back(part(output, share, shares));
        }
        return parts;
    }
    Outcome merge(Strings arguments) const
    {
        arguments.insert(arguments.begin(), "merge");
        return run(arguments);
    }
    TemporaryFolder folder_;
};

TEST_F(MergeCommand, SevenSharesAreTheBytesOfOneRun)
{
    for (const auto& [input, output, options] :
         {std::tuple("a.obj", "x.ply", Strings{"--ground", "--max-distance", "50%"}),
          {"a.glb", "x.glb", Strings{"--quality", "best", "--encoding", "srgb"}},
          {"a.obj", "x.obj", Strings{"--engine", "rays", "--rays", "9", "--values", "point"}},
          {"a.obj", "x.off", Strings{"--engine", "disks"}}}) {
        ASSERT_EQ(bake(input, output, options).code, 0);
        const std::string expected = contents_of(folder_ / output);
        fs::remove(folder_ / output);
        const Outcome outcome = merge(bake_parts(input, output, 7, options));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("  error "), outcome.out.npos) << outcome.out;
        EXPECT_EQ(contents_of(folder_ / output), expected) << output;
    }
}

TEST_F(MergeCommand, WhatIsMissingDoubleForeignOrDamagedIsNamed)
{
    const Strings parts = bake_parts("a.obj", "x.ply", 2);
    ASSERT_EQ(bake("a.obj", "other.ply", {"--quality", "draft", "--part", "1/2"}).code, 0);
    const std::string whole = contents_of(parts[0]);
    std::ofstream(folder_ / "cut", std::ios::binary) << whole.substr(0, whole.size() - 1);
    std::string turned = whole;
    turned[whole.size() / 2] ^= 1;
    std::ofstream(folder_ / "turned", std::ios::binary) << turned;
    const std::string damaged = "is no part of a bake, or is damaged";
    for (const auto& [given, sentence] :
         {std::pair(Strings{parts[0]}, std::string("share 1 of 2 is missing: 1 parts were given")),
          {Strings{parts[0], parts[1], parts[0]}, "is share 2 as "},
          {Strings{parts[0], part("other.ply", 1, 2)}, "belongs to another bake than "},
          {Strings{parts[1], folder_ / "cut"}, damaged},
          {Strings{parts[1], folder_ / "turned"}, damaged},
          {Strings{folder_ / "a.obj"}, damaged},
          {Strings{folder_ / "none"}, "no such file"}}) {
        const Outcome outcome = merge(given);
        EXPECT_EQ(outcome.code, 1) << sentence;
        EXPECT_NE(outcome.err.find(sentence), outcome.err.npos) << outcome.err;
        EXPECT_FALSE(fs::exists(folder_ / "x.ply"));
    }
    write_obj(folder_ / "a.obj", scenes::nested_shells(2, 0.3, 6));
    const Outcome changed = merge(parts);
    EXPECT_EQ(changed.code, 1);
    EXPECT_NE(changed.err.find("is not as it was when its parts were baked"), changed.err.npos)
        << changed.err;
}

TEST_F(MergeCommand, SharesOfWhatHasNoneAreRefused)
{
    for (const Strings& wrong : {Strings{"--part", "0/2"},
                                 {"--part", "3/2"},
                                 {"--part", "1"},
                                 {"--part", "1/2/3"},
                                 {"--part", "1/2", "--error", "0.1"},
                                 {"--part", "1/2", "--device", "gpu"},
                                 {"--part", "1/2", "--at", "texels"},
                                 {"--part", "1/2", "--resume"}}) {
        EXPECT_EQ(bake("a.obj", "x.ply", wrong).code, 2) << wrong[1];
        EXPECT_FALSE(fs::exists(part("x.ply", 1, 2)));
    }
}

}  // namespace
}  // namespace surfelao
