#include "surfels/scene_io.h"

#include "surfels/errors.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, gone afterwards.
class SceneIo : public testing::Test {
protected:
    SceneIo()
        : folder_(fs::temp_directory_path() /
                  (std::string("surfelao_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name()))
    {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~SceneIo() override { fs::remove_all(folder_); }

    fs::path file(const std::string& name, const std::string& contents) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << contents;
        return folder_ / name;
    }
    fs::path path(const std::string& name) const { return folder_ / name; }

    static std::string text_of(const fs::path& path)
    {
        std::ostringstream text;
        text << std::ifstream(path, std::ios::binary).rdbuf();
        return text.str();
    }

    std::size_t file_count() const
    {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

private:
    fs::path folder_;
};

// 0..3 a square, 4 unused; 3-4 corners; texture and normal indices beside
constexpr const char* kSquareObj =
    "# square\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\n"
    "vt 0 0\nvn 0 0 1\ng side\nf 1/1/1 2//1 3/1 4\n";

std::vector<Occlusion> ramp(std::size_t count)
{
    std::vector<Occlusion> occlusion(count);
    for (std::size_t i = 0; i < count; ++i)
        occlusion[i] = {static_cast<float>(i) / static_cast<float>(count), {0, 0, 1}};
    return occlusion;
}

TEST_F(SceneIo, ObjKeepsItsOwnTextExceptForVertexColours)
{
    const Scene scene = read_scene(file("square.obj", kSquareObj));
    EXPECT_EQ(scene.name, "square.obj");
    EXPECT_EQ(scene.positions.size(), 5u);
    EXPECT_EQ(scene.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    write_scene(path("out.obj"), scene, ramp(5));
    EXPECT_EQ(text_of(path("out.obj")),
              "# square\nmtllib none.mtl\nv 0 0 0 1.000000 1.000000 1.000000\n"
              "v 1 0 0 0.800000 0.800000 0.800000\nv 1 1 0 0.600000 0.600000 0.600000\n"
              "v 0 1 0 0.400000 0.400000 0.400000\nv 5 5 5 0.200000 0.200000 0.200000\n"
              "vt 0 0\nvn 0 0 1\ng side\nf 1/1/1 2//1 3/1 4\n");
    EXPECT_EQ(file_count(), 2u);
}

TEST_F(SceneIo, PlyFromObjKeepsVerticesAndPolygons)
{
    const Scene scene = read_scene(file("square.obj", kSquareObj));
    write_scene(path("out.ply"), scene, ramp(5));
    const Scene again = read_scene(path("out.ply"));
    EXPECT_EQ(again.positions, scene.positions);
    EXPECT_EQ(again.triangles, scene.triangles);
    EXPECT_NE(text_of(path("out.ply")).find("element face 1\n"), std::string::npos);
}

TEST_F(SceneIo, AFailedWriteLeavesTheOldFileAndNothingElse)
{
    const Scene scene = read_scene(file("square.obj", kSquareObj));
    fs::create_directories(path("folder.ply"));
    EXPECT_THROW(write_scene(path("folder.ply"), scene, ramp(5)), InputError);
    EXPECT_THROW(write_scene(path("out.stl"), scene, ramp(5)), InputError);
    EXPECT_THROW(write_scene(path("missing/out.ply"), scene, ramp(5)), InputError);
    EXPECT_EQ(file_count(), 2u);
}

}  // namespace
}  // namespace surfelao
