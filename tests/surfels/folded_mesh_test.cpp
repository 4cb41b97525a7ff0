#include "surfels/folded_mesh.h"

#include "scenes.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

void expect_same(const Scene& scene, const Scene& other)
{
    EXPECT_EQ(scene.triangles, other.triangles);
    EXPECT_EQ(scene.positions, other.positions);
}

Scene rounded(Scene scene)
{
    for (glm::dvec3& position : scene.positions)
        position = glm::vec3(position);
    return scene;
}

TEST(FoldedScene, HoldsNothingOfFloatsAndTheGeometrysTrianglesAndGivesAllBack)
{
    Mesh mesh = make_mesh(rounded(scenes::bumpy_sphere(8)));
    const Scene scene = mesh.scene;
    FoldedScene folded(mesh);
    EXPECT_EQ(mesh.scene.triangles.capacity(), 0u);
    EXPECT_EQ(mesh.scene.positions.capacity(), 0u);
    folded.unfold();
    expect_same(mesh.scene, scene);
}

// A tenth is no float; a triangle without area is not in the geometry.
TEST(FoldedScene, LeavesWhatItCouldNotGiveBack)
{
    Scene scene = rounded(scenes::bumpy_sphere(8));
    scene.positions[5].x = 0.1;
    scene.triangles.emplace_back(0, 1, 1);
    ++scene.parts[0].triangle_count;
    Mesh mesh = make_mesh(scene);
    FoldedScene folded(mesh);
    expect_same(mesh.scene, scene);
    folded.unfold();
    expect_same(mesh.scene, scene);
}

// A vertex has a wedge for each of its triangles.
TEST(FoldedCorners, AreGoneAndThereAgain)
{
    Mesh mesh = make_mesh(scenes::bumpy_sphere(8), {.source = NormalSource::flat});
    const std::vector<glm::uvec3> corners = mesh.surface.split_corners;
    ASSERT_FALSE(corners.empty());
    FoldedCorners folded(mesh);
    EXPECT_EQ(mesh.surface.split_corners.capacity(), 0u);
    folded.unfold();
    EXPECT_EQ(mesh.surface.split_corners, corners);
}

}  // namespace
}  // namespace surfelao
