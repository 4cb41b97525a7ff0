// A glTF at a moment of its animation.
#include "files/gltf_animation.h"

#include "gltf_maker.h"

#include "files/gltf_io.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;
using test::square;

using Values = std::vector<double>;

TEST(Sample, BeforeBetweenAndBehindTheKeys)
{
    KeyFrames keys{{1.0, 2.0, 4.0}, {0, 10, 20, 30, 40, 50}, 2, KeyBlend::linear};
    EXPECT_EQ(sample(keys, 0.0), (Values{0, 10}));
    EXPECT_EQ(sample(keys, 1.25), (Values{5, 15}));
    EXPECT_EQ(sample(keys, 3.0), (Values{30, 40}));
    EXPECT_EQ(sample(keys, 9.0), (Values{40, 50}));
    keys.blend = KeyBlend::step;
    EXPECT_EQ(sample(keys, 1.99), (Values{0, 10}));
    EXPECT_EQ(sample(keys, 2.0), (Values{20, 30}));
}

// Tangents are per second: over two seconds from 0 to 0, leaving at 1 a second and arriving level:
// 2 (t^3 - 2 t^2 + t) at t = 1/2 is 1/4.
TEST(Sample, CubicTangentsArePerSecond)
{
    const KeyFrames keys{{0.0, 2.0}, {0, 0, 1, 0, 0, 0}, 1, KeyBlend::cubic};
    EXPECT_DOUBLE_EQ(sample(keys, 1.0)[0], 0.25);
    EXPECT_DOUBLE_EQ(sample(keys, 5.0)[0], 0.0);
}

// A quarter turn, the target's quaternion given with the other sign: a third of the way is 30
// degrees along the shorter arc.
TEST(Sample, RotationsGoAlongTheShorterArc)
{
    const double half = std::sqrt(0.5);
    const KeyFrames keys{{0.0, 3.0}, {0, 0, 0, 1, 0, 0, -half, -half}, 4, KeyBlend::linear, true};
    const Values at = sample(keys, 1.0);
    EXPECT_NEAR(at[2], std::sin(std::numbers::pi / 12), 1e-12);
    EXPECT_NEAR(at[3], std::cos(std::numbers::pi / 12), 1e-12);
    // half a turn, whose way is anybody's choice: of unit length all the same
    const KeyFrames turn{{0.0, 1.0}, {0, 0, 0, 1, 0, 0, 1, 0}, 4, KeyBlend::linear, true};
    EXPECT_NEAR(sample(turn, 0.5)[2], half, 1e-12);
}

/// The square's node moves from (0, 0, 0) to (4, 0, 0) in two seconds, in the animation "slide".
GltfMaker sliding_square()
{
    GltfMaker maker = square();
    const int times =
        maker.add_accessor(maker.add_view(bytes_of<float>({0, 2})), 5126, "SCALAR", 2);
    const int places = maker.add_vectors<float>({0, 0, 0, 4, 0, 0});
    maker.document["animations"] = {
        {{"name", "slide"},
         {"samplers", {{{"input", times}, {"output", places}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
           {{"sampler", 0}, {"target", {{"path", "pointer"}}}}}}}};
    return maker;
}

Scene read_at(const GltfMaker& maker, double seconds, const std::string& animation = {})
{
    return read_gltf("made.glb", maker.glb(), Moment{seconds, animation});
}

TEST(GltfAnimation, MovesNodes)
{
    const GltfMaker maker = sliding_square();
    EXPECT_EQ(read_gltf("made.glb", maker.glb()).positions[0].x, 0.0);
    const Scene scene = read_at(maker, 0.5);
    EXPECT_EQ(scene.positions[0].x, 1.0);
    EXPECT_EQ(scene.notes,
              std::vector<std::string>{"the pose is that of animation 0 \"slide\" at 0.5 s"});
    EXPECT_EQ(read_at(maker, 100.0, "slide").positions[0].x, 4.0);
    EXPECT_EQ(read_at(maker, 1.0, "0").positions[0].x, 2.0);
}

TEST(GltfAnimation, MovesMorphWeights)
{
    GltfMaker maker = square();
    const int shift = maker.add_vectors<float>({0, 0, 8, 0, 0, 8, 0, 0, 8, 0, 0, 8});
    test::primitive(maker)["targets"] = {{{"POSITION", shift}}};
    const int times =
        maker.add_accessor(maker.add_view(bytes_of<float>({0, 1})), 5126, "SCALAR", 2);
    const int weights =
        maker.add_accessor(maker.add_view(bytes_of<float>({0, 1})), 5126, "SCALAR", 2);
    maker.document["animations"] = {
        {{"samplers", {{{"input", times}, {"output", weights}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    EXPECT_EQ(read_at(maker, 0.25).positions[0].z, 2.0);
}

/// The sentence with which reading at a moment is refused; empty where it is not.
std::string refusal(const GltfMaker& maker, const std::string& animation = {})
{
    try {
        static_cast<void>(read_at(maker, 0.5, animation));
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(GltfAnimation, RefusesWhatIsMalformed)
{
    EXPECT_EQ(refusal(square()), "made.glb: has no animation");
    EXPECT_EQ(refusal(sliding_square(), "jump"),
              "made.glb: has no animation \"jump\", but \"slide\"");
    const auto spoilt = [](const char* pointer, const json& value) {
        GltfMaker maker = sliding_square();
        maker.document[json::json_pointer(pointer)] = value;
        return refusal(maker);
    };
    EXPECT_EQ(spoilt("/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
              "made.glb: node 0 has a matrix, but animation 0 moves it");
    EXPECT_EQ(spoilt("/animations/0/channels/0/sampler", 1),
              "made.glb: animation 0 channel 0: sampler 1 is out of range, there are 1 samplers");
    EXPECT_EQ(spoilt("/animations/0/channels/0/target/node", 7),
              "made.glb: animation 0 channel 0 target: node 7 is out of range, there are 1 nodes");
    EXPECT_EQ(spoilt("/animations/0/samplers/0/output", 99).substr(0, 43),
              "made.glb: animation 0 sampler 0: output 99 ");
    EXPECT_EQ(spoilt("/animations/0/samplers/0/interpolation", "BEZIER"),
              "made.glb: animation 0 sampler 0 has the unknown interpolation \"BEZIER\"");
    EXPECT_EQ(spoilt("/animations", "dance"), "made.glb: animations is not an array");
    GltfMaker backwards = sliding_square();
    const int times =
        backwards.add_accessor(backwards.add_view(bytes_of<float>({2, 2})), 5126, "SCALAR", 2);
    backwards.document["animations"][0]["samplers"][0]["input"] = times;
    EXPECT_NE(refusal(backwards).find("time 1 is not later than the one before"),
              std::string::npos);
    GltfMaker few = sliding_square();
    const int three = few.add_accessor(few.add_view(bytes_of<float>({1, 2, 3})), 5126, "SCALAR", 3);
    few.document["animations"][0]["samplers"][0]["input"] = three;
    EXPECT_NE(refusal(few).find("does not fit the 3 times of its sampler"), std::string::npos);
}

}  // namespace
}  // namespace surfelao
