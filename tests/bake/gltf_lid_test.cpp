// A lid over a floor, told in the ways that glTF has for it: each must bake like the plain one.
#include "bake/bake.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "tests/files/gltf_maker.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using nlohmann::json;
using test::GltfMaker;

constexpr std::size_t kFloorCells = 8;
constexpr std::size_t kFloorCentre = 40;

/// The share of the cosine-weighted hemisphere that a square of half width 1 covers from a height
/// of 0.5: 4 / pi * 2 / sqrt(5) * atan(2 / sqrt(5)).
constexpr double kUnderTheLid = 0.8310;

template <typename T>
int add_values(GltfMaker& maker, const std::vector<T>& values, const char* type,
               std::size_t dimension)
{
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return maker.add_accessor(maker.add_view(bytes), test::component_type<T>(), type,
                              values.size() / dimension);
}

/// Returns the mesh's index. What is added to z is for lids that are to be moved down again.
int add_mesh(GltfMaker& maker, const Scene& scene, float up = 0.0f)
{
    std::vector<float> positions;
    for (const glm::dvec3& p : scene.positions)
        positions.insert(positions.end(), {static_cast<float>(p.x), static_cast<float>(p.y),
                                           static_cast<float>(p.z) + up});
    std::vector<std::uint32_t> indices;
    for (const glm::uvec3& t : scene.triangles)
        indices.insert(indices.end(), {t.x, t.y, t.z});
    const int vertices = add_values(maker, positions, "VEC3", 3);
    return maker.add("meshes", {{"primitives",
                                 {{{"attributes", {{"POSITION", vertices}}},
                                   {"indices", add_values(maker, indices, "SCALAR", 1)}}}}});
}

/// Node 0 is the floor with mesh 0, node 1 the lid with mesh 1.
struct LidAndFloor {
    GltfMaker maker;
    std::size_t lid_vertices = 0;
    std::vector<std::string> notes = {};  ///< of the bake

    explicit LidAndFloor(float up = 0.0f)
    {
        const Scene lid = scenes::box({-1, -1, 0.5}, {1, 1, 0.6}, 2);
        lid_vertices = lid.positions.size();
        maker.add("nodes", {{"mesh", add_mesh(maker, scenes::sheet({-2, -2, 0}, {4, 0, 0},
                                                                   {0, 4, 0}, kFloorCells))}});
        maker.add("nodes", {{"mesh", add_mesh(maker, lid, up)}});
        maker.document["scenes"][0]["nodes"] = {0, 1};
    }

    json& lid() { return maker.document["nodes"][1]; }
    json& lid_primitive() { return maker.document["meshes"][1]["primitives"][0]; }

    /// Occlusion at the centre of the floor, out of the file that bake() writes.
    double centre(const PartChoice& parts = {})
    {
        const TemporaryFolder folder;
        BakeSettings settings;
        settings.input = folder.file("in.glb", maker.glb());
        settings.output = folder / "out.glb";
        settings.target.values = VertexValues::point;
        settings.parts = parts;
        notes = bake(settings).notes;
        const std::string glb = contents_of(settings.output);
        std::uint32_t text_size = 0;
        std::memcpy(&text_size, glb.data() + 12, sizeof text_size);
        const json document = json::parse(glb.substr(20, text_size));
        const std::size_t mesh = document["nodes"][0]["mesh"];
        const json& accessor =
            document["accessors"]
                    [document["meshes"][mesh]["primitives"][0]["attributes"]["_OCCLUSION"]
                         .get<std::size_t>()];
        const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        float value = 0.0f;
        std::memcpy(&value,
                    glb.data() + 28 + text_size + view["byteOffset"].get<std::size_t>() +
                        accessor["byteOffset"].get<std::size_t>() + kFloorCentre * sizeof value,
                    sizeof value);
        return value;
    }
};

TEST(GltfLid, PlainOneHasTheExactValue)
{
    EXPECT_NEAR(LidAndFloor().centre(), kUnderTheLid, 0.01);
}

TEST(GltfLid, SkinnedLidStandsWhereItsJointsPutIt)
{
    LidAndFloor world;
    world.lid().update({{"skin", 0}, {"translation", {0, 0, 50}}, {"scale", {0.01, 0.01, 0.01}}});
    world.maker.document["skins"] = {{{"joints", {world.maker.add("nodes", json::object())}}}};
    const std::vector<std::uint8_t> joints(4 * world.lid_vertices, 0);
    const std::vector<float> weights(4 * world.lid_vertices, 0.25f);
    world.lid_primitive()["attributes"].update(
        {{"JOINTS_0", add_values(world.maker, joints, "VEC4", 4)},
         {"WEIGHTS_0", add_values(world.maker, weights, "VEC4", 4)}});
    EXPECT_NEAR(world.centre(), kUnderTheLid, 0.01);
}

TEST(GltfLid, MorphedLidHasItsDefaultWeights)
{
    LidAndFloor world(2.5f);
    EXPECT_LT(world.centre(), 0.2);
    std::vector<float> down;
    for (std::size_t v = 0; v < world.lid_vertices; ++v)
        down.insert(down.end(), {0.0f, 0.0f, -2.5f});
    world.lid_primitive()["targets"] = {{{"POSITION", add_values(world.maker, down, "VEC3", 3)}}};
    world.maker.document["meshes"][1]["weights"] = {1};
    EXPECT_NEAR(world.centre(), kUnderTheLid, 0.01);
}

TEST(GltfLid, HiddenLidCoversNothing)
{
    LidAndFloor world;
    world.lid()["extensions"]["KHR_node_visibility"] = {{"visible", false}};
    EXPECT_EQ(world.centre(), 0.0);
}

TEST(GltfLid, InstancesOfTheLidCoverTheFloor)
{
    LidAndFloor world(2.5f);
    const int places =
        add_values(world.maker, std::vector<float>{0, 0, -2.5f, 0, 0, -1.5f}, "VEC3", 3);
    world.lid()["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", {{"TRANSLATION", places}}}};
    EXPECT_NEAR(world.centre(), kUnderTheLid, 0.01);
}

TEST(GltfLid, ACentreFarAwayChangesNothing)
{
    LidAndFloor world;
    world.maker.document["extensionsRequired"] = {"CESIUM_RTC"};
    world.maker.document["extensions"]["CESIUM_RTC"]["center"] = {6e6, 1e6, 2e6};
    EXPECT_NEAR(world.centre(), kUnderTheLid, 0.01);
}

// MASK without a texture is there or gone as a whole; what light goes through is told, and open on
// request.
TEST(GltfLid, MaterialsWithAlphaOccludeAsTheySay)
{
    const struct {
        json material;
        ClearSurfaces clear;
        double occlusion;
        std::size_t notes;
    } rows[] = {
        {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}},
         ClearSurfaces::solid,
         0.0,
         1},
        {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.6}}}}},
         ClearSurfaces::open,
         kUnderTheLid,
         0},
        {{{"alphaMode", "MASK"},
          {"alphaCutoff", 0.7},
          {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.6}}}}},
         ClearSurfaces::solid,
         0.0,
         1},
        {{{"alphaMode", "BLEND"}}, ClearSurfaces::solid, kUnderTheLid, 1},
        {{{"alphaMode", "BLEND"}}, ClearSurfaces::open, 0.0, 1},
        {{{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}},
         ClearSurfaces::open,
         0.0,
         1},
        {{{"extensions", {{"KHR_materials_transmission", json::object()}}}},
         ClearSurfaces::open,
         kUnderTheLid,
         0},
    };
    for (const auto& row : rows) {
        LidAndFloor world;
        world.maker.document["materials"] = nlohmann::json::array({row.material});
        world.maker.document["materials"][0]["name"] = "Glass";
        world.lid_primitive()["material"] = 0;
        EXPECT_NEAR(world.centre({.clear = row.clear}), row.occlusion, 0.01) << row.material;
        ASSERT_EQ(world.notes.size(), row.notes) << row.material;
        for (const std::string& note : world.notes)
            EXPECT_NE(note.find("material Glass"), std::string::npos) << note;
    }
}

}  // namespace
}  // namespace surfelao
