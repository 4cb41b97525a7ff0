#include "gltf_maker.h"

#include "surfels/errors.h"
#include "surfels/scene_io.h"

#include <gtest/gtest.h>

#include <limits>

namespace surfelao {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::one_triangle;
using test::square;
using test::TemporaryFolder;

using Positions = std::vector<glm::dvec3>;
using Triangles = std::vector<glm::uvec3>;

Scene read(const GltfMaker& maker)
{
    const TemporaryFolder folder;
    return read_scene(maker.save_glb(folder / "made.glb"));
}

const Positions kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Triangles kSquareTriangles = {{0, 1, 2}, {0, 2, 3}};

TEST(GltfReader, ReadsABinaryFile)
{
    const Scene scene = read(square());
    EXPECT_EQ(scene.name, "made.glb");
    EXPECT_EQ(scene.positions, kSquare);
    EXPECT_EQ(scene.triangles, kSquareTriangles);
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.parts[0].vertex_count, 4u);
    EXPECT_EQ(scene.parts[0].triangle_count, 2u);
    EXPECT_EQ(scene.parts[0].node, 0);
    EXPECT_EQ(scene.parts[0].mesh, 0);
    EXPECT_EQ(scene.parts[0].primitive, 0);
    EXPECT_NE(scene.asset, nullptr);
}

TEST(GltfReader, ReadsATextFileWithAnExternalBuffer)
{
    const TemporaryFolder folder;
    EXPECT_EQ(read_scene(square().save_gltf(folder / "made.gltf")).positions, kSquare);
}

TEST(GltfReader, ReadsADataUri)
{
    GltfMaker maker = one_triangle();
    // three zero bytes are "AAAA"; 36 bytes of zeros with 1.0f = 00 00 80 3F at 12 and 28
    maker.document["buffers"][0]["uri"] =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    const TemporaryFolder folder;
    const Scene scene = read_scene(test::write_file(folder / "made.gltf", maker.document.dump()));
    EXPECT_EQ(scene.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(GltfReader, InstancesAreMovedByTheirNodes)
{
    GltfMaker maker = square();
    maker.document["nodes"] = {{{"name", "left"}, {"mesh", 0}},
                               {{"children", {2}}, {"scale", {2, 2, 2}}},
                               {{"name", "right"}, {"mesh", 0}, {"translation", {5, 0, 0}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = read(maker);
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[0].name, "left");
    EXPECT_EQ(scene.parts[1].name, "right");
    EXPECT_EQ(scene.parts[1].node, 2);
    EXPECT_EQ(scene.parts[1].first_vertex, 4u);
    EXPECT_EQ(scene.parts[1].first_triangle, 2u);
    EXPECT_EQ(scene.positions[4], glm::dvec3(10, 0, 0));
    EXPECT_EQ(scene.positions[6], glm::dvec3(12, 2, 0));
    EXPECT_EQ(scene.triangles[2], glm::uvec3(4, 5, 6));
}

TEST(GltfReader, MirroringTurnsTheWinding)
{
    GltfMaker maker = one_triangle();
    maker.document["nodes"][0]["scale"] = {-1, 1, 1};
    const Scene scene = read(maker);
    EXPECT_EQ(scene.positions[1], glm::dvec3(-1, 0, 0));
    EXPECT_EQ(scene.triangles, (Triangles{{0, 2, 1}}));
}

TEST(GltfReader, RefusesAnIndexOutOfRangeInOneSentence)
{
    GltfMaker maker = square();
    maker.bin[48] = 9;
    const TemporaryFolder folder;
    const std::filesystem::path path = maker.save_glb(folder / "made.glb");
    try {
        static_cast<void>(read_scene(path));
        FAIL() << "was read";
    } catch (const InputError& error) {
        EXPECT_EQ(error.what(), path.string() +
                                    ": mesh 0 primitive 0 indices accessor 1: "
                                    "index 0 is 9, but there are 4 vertices");
    }
}

}  // namespace
}  // namespace surfelao
