#include "viewer/joined_scene.h"

#include "bake/vertex_target.h"
#include "bake/world.h"
#include "files/scene_io.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "temporary_folder.h"
#include "viewer/part_list.h"
#include "viewer/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

/// A floor, and a box that stands over it.
struct TwoFiles {
    TwoFiles()
    {
        write_obj(folder / "floor.obj", scenes::box({0, 0, -1}, {4, 4, 0}, 12));
        write_obj(folder / "over.obj", scenes::box({1, 1, 0.2}, {3, 3, 1}, 6));
    }
    TemporaryFolder folder;
};

// Not to the bit: samples of the surface are others where triangles have other numbers.
TEST(JoinedScene, ASessionFindsWhatFilesThatAreBakedTogetherGet)
{
    const TwoFiles files;
    const std::vector<std::filesystem::path> paths = {files.folder / "floor.obj",
                                                      files.folder / "over.obj"};
    std::vector<float> expected;
    for (const Mesh& mesh : read_world(paths, {}, {}).meshes) {
        const VertexTarget target(std::make_shared<const Mesh>(mesh), {});
        const Solution solution = solve(prepare(mesh.occluding(), {}), target.receivers());
        for (const Occlusion& value : target.values(solution.occlusion))
            expected.push_back(value.occlusion);
    }
    SessionSettings settings;
    settings.beside = {paths[1]};
    Session session;
    session.open(paths[0], UpAxis::z, settings);
    for (int i = 0; i < 30000 && (!session.state().is_solved || session.state().is_draft); ++i) {
        static_cast<void>(session.update());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(session.state().is_solved) << session.state().message;
    ASSERT_EQ(session.state().model->geometry().positions.size(), expected.size());
    float farthest = 0.0f, darkest = 0.0f;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        farthest = std::max(farthest, std::abs(session.occlusion()[i].occlusion - expected[i]));
        darkest = std::max(darkest, expected[i]);
    }
    EXPECT_LT(farthest, 0.01f);
    EXPECT_GT(darkest, 0.5f);  // under the box
}

// Of two files with one colour each, the second with a name for it.
TEST(JoinedScene, EachFileKeepsItsColoursAndItsNames)
{
    const TemporaryFolder folder;
    folder.file("b.mtl", "newmtl red\nKd 1 0 0\n");
    const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    std::vector<Scene> scenes;
    scenes.push_back(read_scene(
        folder.file("a.obj", std::string(triangle) + "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")));
    scenes.push_back(read_scene(folder.file(
        "b.obj", "mtllib b.mtl\n" + std::string(triangle) + "o door\nusemtl red\nf 1 2 3\n")));
    const Scene all = joined_scene(scenes);
    ASSERT_TRUE(all.asset != nullptr);
    const BaseColors colors = all.asset->base_colors();
    ASSERT_EQ(colors.triangles.size(), 2u);
    EXPECT_EQ(colors.materials[colors.triangles[0]].factor, glm::vec3(1, 1, 1));
    EXPECT_EQ(colors.materials[colors.triangles[1]].factor, glm::vec3(1, 0, 0));
    std::vector<std::string> names;
    for (const Label* label : parting_labels(all))
        names.push_back(label->name + " " + std::to_string(label->ranges.front().first));
    EXPECT_EQ(names, (std::vector<std::string>{"a.obj 0", "door 1"}));
    ASSERT_EQ(all.uvs.size(), 1u);
    EXPECT_EQ(all.uvs[0].values[all.uvs[0].corners[0].y], glm::dvec2(1, 1));
    EXPECT_EQ(all.uvs[0].corners[1], glm::uvec3(UvSet::kNone));
}

TEST(JoinedScene, PointsAreRefused)
{
    const TemporaryFolder folder;
    const std::vector<Scene> scenes = {read_scene(folder.file("p.xyz", "0 0 0\n1 0 0\n0 1 0\n")),
                                       scenes::box({0, 0, 0}, {1, 1, 1}, 1)};
    EXPECT_THROW(static_cast<void>(joined_scene(scenes)), InputError);
}

}  // namespace
}  // namespace surfelao
