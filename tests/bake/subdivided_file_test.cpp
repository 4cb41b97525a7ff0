// Files that a bake has subdivided: they hold the surface that was asked.
#include "bake/bake.h"
#include "bake/subdivide_job.h"
#include "files/scene_io.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

namespace fs = std::filesystem;

/// A folded body whose smooth normals turn within its coarse faces and break at its folds, on a
/// floor.
Scene folded_body()
{
    return scenes::sheet({-3, -3, -1.2}, {6, 0, 0}, {0, 6, 0}, 1) +
           scenes::moved(scenes::sphere({0, 0, 0}, 1, 8), [](glm::dvec3 p) {
               return p * (1.0 + 0.3 * std::abs(std::sin(4.0 * p.x) * std::cos(3.0 * p.y)));
           });
}

BakeReport subdivided_bake(const fs::path& input, const fs::path& output)
{
    BakeSettings settings;
    settings.input = input;
    settings.output = output;
    settings.subdivide = 0.02;
    settings.check = 0;
    return bake(settings);
}

constexpr const char* kNames[] = {"a.ply", "a.obj", "a.off", "a.glb"};

TEST(SubdividedFile, IsHardlyCutByASecondRun)
{
    const TemporaryFolder folder;
    const Scene scene = folded_body();
    write_scene(folder / "in.off", scene, std::vector<Occlusion>(scene.positions.size()));
    for (const std::string name : kNames) {
        const BakeReport once = subdivided_bake(folder / "in.off", folder / name);
        const BakeReport twice = subdivided_bake(folder / name, folder / ("b" + name));
        EXPECT_GT(once.vertices, scene.positions.size() + 1000) << name;
        EXPECT_LT(static_cast<double>(twice.vertices), 1.01 * static_cast<double>(once.vertices))
            << name;
    }
}

/// By the corners of each triangle.
std::vector<glm::vec3> corner_normals(const Mesh& mesh)
{
    std::vector<glm::vec3> normals;
    for (const glm::uvec3& wedges : mesh.surface.corners(mesh.geometry)) {
        for (int k = 0; k < 3; ++k)
            normals.push_back(mesh.surface.normals[wedges[k]]);
    }
    return normals;
}

// From each format into each other one.
TEST(SubdividedFile, HoldsTheNormalsThatWereAsked)
{
    const TemporaryFolder folder;
    const Scene scene = folded_body();
    for (const std::string input : {"in.ply", "in.obj", "in.off"}) {
        write_scene(folder / input, scene, std::vector<Occlusion>(scene.positions.size()));
        const Mesh mesh = make_mesh(read_scene(folder / input));
        Occluders occluders(mesh.geometry);
        SubdivisionReport report;
        const Mesh asked = subdivided(mesh, 0.02, {}, {}, occluders, {}, report);
        const std::vector<glm::vec3> normals = corner_normals(asked);
        EXPECT_TRUE(std::equal(mesh.scene.positions.begin(), mesh.scene.positions.end(),
                               asked.scene.positions.begin()));
        EXPECT_TRUE(asked.surface.extra_vertices.empty()) << input;
        for (const std::string output : {"a.ply", "a.obj", "a.off"}) {
            write_scene(folder / output, asked.scene,
                        std::vector<Occlusion>(asked.scene.positions.size()));
            const Mesh again = make_mesh(read_scene(folder / output));
            EXPECT_EQ(again.surface.corners_from_file, 3 * again.geometry.triangles.size());
            const std::vector<glm::vec3> held = corner_normals(again);
            ASSERT_EQ(held.size(), normals.size());
            float most = 0.0f;  // ten roundings of a float: they are made unit twice
            for (std::size_t i = 0; i < held.size(); ++i)
                most = std::max(most, glm::distance(held[i], normals[i]));
            EXPECT_LT(most, 6e-7f) << input << ' ' << output;
        }
    }
}

// Baked again, as it is, it gets the values that it has. Rays, as masks group what they occlude by.
TEST(SubdividedFile, IsAnsweredAsWhatWasCut)
{
    const TemporaryFolder folder;
    const Scene scene = folded_body();
    write_scene(folder / "in.off", scene, std::vector<Occlusion>(scene.positions.size()));
    BakeSettings settings;
    settings.input = folder / "in.off";
    settings.output = folder / "a.ply";
    settings.subdivide = 0.02;
    settings.check = 0;
    settings.engine.engine = Engine::rays;
    settings.engine.rays = 64;
    const std::vector<Occlusion> first =
        bake_scene(read_scene(settings.input), {}, settings).values;
    settings.subdivide.reset();
    settings.input = folder / "a.ply";
    settings.output.clear();
    const std::vector<Occlusion> second =
        bake_scene(read_scene(settings.input), {}, settings).values;
    ASSERT_EQ(second.size(), first.size());
    double sum = 0.0;
    for (std::size_t v = 0; v < first.size(); ++v)
        sum += std::abs(double{first[v].occlusion} - double{second[v].occlusion});
    // a ray in some thousand passes on the other side of an edge: coordinates are rounded to floats
    EXPECT_LT(sum / static_cast<double>(first.size()), 1e-4);
}

}  // namespace
}  // namespace surfelao
