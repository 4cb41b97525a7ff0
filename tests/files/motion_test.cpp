// How the parts of a glTF move: against hand-made keys, and against the file read at the moment.
#include "files/motion.h"

#include "gltf_maker.h"

#include "files/gltf_io.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;

/// Squares on a stage of nodes that animation 0 moves from second 1 to second 3.
class Stage {
public:
    /// Node 0, the root, is there.
    Stage()
    {
        maker = test::square();
        maker.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
            maker.add_vectors<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
        maker.document["nodes"] = {{{"children", json::array()}}};
        maker.document["animations"] = {
            {{"name", "play"}, {"samplers", json::array()}, {"channels", json::array()}}};
        times_ = maker.add_accessor(maker.add_view(bytes_of<float>({1, 3})), 5126, "SCALAR", 2);
    }

    /// A child of `parent`.
    int node(int parent, json content)
    {
        const int index = maker.add("nodes", content);
        maker.document["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(index);
        return index;
    }

    void move(int node, const char* path, const char* type, std::initializer_list<float> from_to,
              const char* blend = "LINEAR")
    {
        json& animation = maker.document["animations"][0];
        const bool is_weights = std::string(path) == "weights";
        const std::size_t width = is_weights ? 1 : (std::string(path) == "rotation" ? 4 : 3);
        const int output = maker.add_accessor(maker.add_view(bytes_of<float>(from_to)), 5126, type,
                                              from_to.size() / width);
        animation["samplers"].push_back(
            {{"input", times_}, {"output", output}, {"interpolation", blend}});
        animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                         {"target", {{"node", node}, {"path", path}}}});
    }

    Scene rest() const { return read_gltf("made.glb", maker.glb()); }
    Scene read_at(double seconds) const
    {
        return read_gltf("made.glb", maker.glb(), Moment{seconds, {}});
    }

    GltfMaker maker;

private:
    int times_ = 0;
};

/// The stage with one of each: still, rigid, hidden at rest, morphed, skinned, instanced.
Stage full_stage()
{
    Stage stage;
    GltfMaker& maker = stage.maker;
    stage.node(0, {{"mesh", 0}, {"name", "still"}});
    const int arm = stage.node(0, {{"rotation", {0, 0, .6, .8}}, {"scale", {1, 2, 1}}});
    stage.node(arm, {{"mesh", 0}, {"translation", {3, 0, 1}}, {"name", "on the arm"}});
    stage.node(arm, {{"mesh", 0}, {"scale", {-1, 1, .5}}, {"name", "mirrored"}});
    const int pop = stage.node(0, {{"mesh", 0}, {"scale", {0, 0, 0}}, {"name", "pops up"}});
    json morph = maker.document["meshes"][0];
    morph["primitives"][0]["targets"] = {
        {{"POSITION", maker.add_vectors<float>({0, 0, 8, 0, 0, 4, 0, 0, 8, 1, 0, 8})},
         {"NORMAL", maker.add_vectors<float>({1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0})}}};
    const int soft = stage.node(arm, {{"mesh", maker.add("meshes", morph)}, {"name", "morphed"}});
    json skinned = maker.document["meshes"][0];
    skinned["primitives"][0]["attributes"]["JOINTS_0"] = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0})),
        5121, "VEC4", 4);
    skinned["primitives"][0]["attributes"]["WEIGHTS_0"] = maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 0, 0, .5, .25, 0, 0, .2f, .8f, 0, 0, 0, 0, 0, 0})),
        5126, "VEC4", 4);
    const int bone = stage.node(0, {{"translation", {0, 1, 0}}});
    const int tip = stage.node(bone, {{"translation", {0, 1, .5}}});
    maker.add("skins", {{"joints", {bone, tip}}});
    stage.node(0, {{"mesh", maker.add("meshes", skinned)}, {"skin", 0}, {"name", "skinned"}});
    stage.move(arm, "translation", "VEC3", {0, 0, 0, 4, -2, 1});
    stage.move(arm, "rotation", "VEC4", {0, 0, .6f, .8f, .8f, 0, 0, -.6f});
    stage.move(pop, "scale", "VEC3", {0, 0, 0, 1, 2, 3});
    stage.move(soft, "weights", "SCALAR", {.5f, -1});
    stage.move(tip, "rotation", "VEC4",
               {0, 0, 0, 0, 0, 0, 0, 1, .1f, 0, 0, 0, 0, 0, .3f, 0, .6f, 0, 0, .8f, 0, 0, 0, 0},
               "CUBICSPLINE");
    return stage;
}

/// The scene's positions as the poses have them; those of parts that are gone are left at rest.
std::vector<glm::dvec3> posed(const Scene& rest, const std::vector<PartPose>& poses)
{
    std::vector<glm::dvec3> positions = rest.positions;
    for (std::size_t p = 0; p < rest.parts.size(); ++p) {
        const Part& part = rest.parts[p];
        for (std::uint32_t v = 0; v < part.vertex_count; ++v) {
            glm::dvec3& position = positions[part.first_vertex + v];
            position = poses[p].positions.empty()
                           ? glm::dvec3(poses[p].from_rest * glm::dvec4(position, 1.0))
                           : poses[p].positions[v];
        }
    }
    return positions;
}

double farthest_apart(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b)
{
    double farthest = a.size() == b.size() ? 0.0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        farthest = std::max(farthest, glm::distance(a[i], b[i]));
    return farthest;
}

TEST(Motion, IsWhatTheFileIsAtTheMoment)
{
    const Stage stage = full_stage();
    const Scene rest = stage.rest();
    const Motion motion(rest, "play");
    for (const double seconds : {1.0, 1.25, 2.0, 2.9, 7.0}) {
        const Scene wanted = stage.read_at(seconds);
        const std::vector<PartPose> poses = motion.at(seconds);
        EXPECT_LT(farthest_apart(posed(rest, poses), wanted.positions), 1e-12) << seconds;
        for (std::size_t p = 0; p < poses.size(); ++p) {
            for (std::size_t v = 0; v < poses[p].normals.size(); ++v)
                EXPECT_EQ(poses[p].normals[v],
                          wanted.normals.values[rest.parts[p].first_vertex + v]);
        }
    }
}

TEST(Motion, TellsWhatMovesAsOne)
{
    const Motion motion(full_stage().rest());
    // still, on the arm, mirrored, morphed (the arm's child, before what follows), pops up, skinned
    EXPECT_EQ(motion.bodies(), (std::vector<std::uint32_t>{0, 1, 1, 2, 3, 4}));
    EXPECT_EQ(motion.deforms(), (std::vector<bool>{false, false, false, true, true, true}));
    EXPECT_EQ(motion.body_count(), 5u);
    EXPECT_EQ(motion.name(), "play");
    EXPECT_EQ(motion.first_seconds(), 1.0);
    EXPECT_EQ(motion.last_seconds(), 3.0);
    const std::vector<PartPose> poses = motion.at(2.5);
    EXPECT_EQ(poses[0].from_rest, glm::dmat4(1.0));
    EXPECT_EQ(poses[1].from_rest, poses[2].from_rest);
    EXPECT_TRUE(poses[4].normals.size() == 4 && poses[1].positions.empty());
}

TEST(Motion, OfKeysMadeByHand)
{
    Stage stage;
    const int node = stage.node(0, {{"mesh", 0}, {"translation", {1, 0, 0}}});
    stage.move(node, "translation", "VEC3", {1, 0, 0, 1, 8, 0});
    stage.move(node, "scale", "VEC3", {1, 1, 1, 3, 3, 3});
    const Motion motion(stage.rest());
    EXPECT_EQ(motion.at(0.0)[0].from_rest, glm::dmat4(1.0));
    // a quarter of the way: scaled by 1.5 about (1, 0, 0), then 2 up
    const glm::dmat4 moved = motion.at(1.5)[0].from_rest;
    EXPECT_NEAR(glm::distance(moved * glm::dvec4(1, 0, 0, 1), glm::dvec4(1, 2, 0, 1)), 0.0, 1e-15);
    EXPECT_NEAR(glm::distance(moved * glm::dvec4(2, 1, 0, 1), glm::dvec4(2.5, 3.5, 0, 1)), 0.0,
                1e-15);
}

// Keys that repeat what a node has anyway move nothing: exporters write them for every node.
TEST(Motion, IdleKeysMoveNothing)
{
    Stage stage;
    const int idle = stage.node(0, {{"mesh", 0}, {"translation", {.1, 0, 0}}});
    const int moved = stage.node(0, {{"mesh", 0}});
    stage.move(idle, "translation", "VEC3", {.1f, 0, 0, .1f, 0, 0});
    stage.move(idle, "scale", "VEC3", {1, 1, 1, 1, 1, 1});
    stage.move(moved, "scale", "VEC3", {1, 1, 1, 1, 1, 2});
    EXPECT_EQ(Motion(stage.rest()).bodies(), (std::vector<std::uint32_t>{0, 1}));
}

// A scale of zero is nothing to see in two directions; in one it leaves a surface.
TEST(Motion, WhatHasNoScaleIsGone)
{
    Stage stage;
    const int node = stage.node(0, {{"mesh", 0}});
    stage.move(node, "scale", "VEC3", {0, 1, 1, 0, 0, 1}, "STEP");
    const Motion motion(stage.rest());
    EXPECT_FALSE(motion.at(1.0)[0].is_gone);
    EXPECT_EQ(motion.at(1.0)[0].from_rest[0], glm::dvec4(0.0));
    EXPECT_TRUE(motion.at(3.0)[0].is_gone);
    const Motion all(full_stage().rest());
    EXPECT_TRUE(all.at(1.0)[4].is_gone);
    EXPECT_FALSE(all.at(1.1)[4].is_gone);
}

/// The sentence with which a motion is refused; empty where it is not.
std::string motion_refusal(const Stage& stage)
{
    try {
        static_cast<void>(Motion(stage.rest()).at(2.0));
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Motion, RefusesWhatIsMalformed)
{
    EXPECT_EQ(motion_refusal(full_stage()), "");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto spoilt = [](const char* path, const char* type,
                           std::initializer_list<float> values) {
        Stage stage;
        stage.move(stage.node(0, {{"mesh", 0}}), path, type, values);
        return motion_refusal(stage);
    };
    const auto has = [](const std::string& sentence, const char* text) {
        return sentence.starts_with("made.glb: ") && sentence.find(text) != std::string::npos;
    };
    EXPECT_TRUE(has(spoilt("translation", "VEC3", {0, 0, 0, 0, nan, 0}), "is not finite"));
    EXPECT_TRUE(has(spoilt("translation", "VEC3", {0, 0, 0}), "does not fit the 2 times"));
    EXPECT_EQ(spoilt("rotation", "VEC4", {0, 0, 0, 0, 0, 0, 0, 0}),
              "made.glb: node 1: rotation has a length of zero or infinity");
    EXPECT_EQ(spoilt("pointer", "VEC3", {0, 0, 0, 0, 0, 0}), "made.glb: animation 0 moves no node");
    Stage nowhere;
    nowhere.node(0, {{"mesh", 0}});
    nowhere.maker.document["animations"][0]["channels"] = {
        {{"sampler", 0}, {"target", {{"path", "translation"}}}}};
    nowhere.maker.document["animations"][0]["samplers"] = {{{"input", 0}, {"output", 0}}};
    EXPECT_EQ(motion_refusal(nowhere), "made.glb: animation 0 moves no node");
    Stage none;
    none.node(0, {{"mesh", 0}});
    none.maker.document.erase("animations");
    EXPECT_EQ(motion_refusal(none), "made.glb: has no animation");
    Scene plain = none.rest();
    plain.asset = nullptr;
    EXPECT_THROW(Motion{plain}, InputError);
}

// A small file whose channels name one long accessor again and again is refused before it is read.
TEST(Motion, RefusesKeysWithoutEnd)
{
    Stage stage;
    const int node = stage.node(0, {{"mesh", 0}});
    GltfMaker& maker = stage.maker;
    constexpr std::size_t kKeys = 100'000;
    std::string bytes;
    for (std::size_t k = 0; k < kKeys; ++k)
        bytes += bytes_of<float>({static_cast<float>(k)});
    const int times = maker.add_accessor(maker.add_view(bytes), 5126, "SCALAR", kKeys);
    json& animation = maker.document["animations"][0];
    for (int i = 0; i < 200; ++i) {
        animation["samplers"].push_back({{"input", times}, {"output", times}});
        animation["channels"].push_back(
            {{"sampler", i}, {"target", {{"node", node}, {"path", "weights"}}}});
    }
    EXPECT_NE(motion_refusal(stage).find("far more than a file of this size may stand for"),
              std::string::npos);
}

TEST(Motion, NamesOfAnimations)
{
    GltfMaker maker = Stage().maker;
    maker.add("animations", {{"samplers", json::array()}, {"channels", json::array()}});
    maker.document["nodes"] = {{{"mesh", 0}}};
    EXPECT_EQ(animations_of(read_gltf("made.glb", maker.glb())),
              (std::vector<std::string>{"play", ""}));
}

}  // namespace
}  // namespace surfelao
