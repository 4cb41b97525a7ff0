// Files of points: what the readers make of them.
#include "files/scene_io.h"
#include "surfels/errors.h"

#include "cloud_cases.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

using namespace test;

class Cloud : public testing::TestWithParam<CloudCase> {};

TEST_P(Cloud, IsReadAsItStands)
{
    const CloudCase& c = GetParam();
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file(c.name, c.contents), {c.columns});
    EXPECT_EQ(scene.positions, c.positions);
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_EQ(scene.normals.values, c.normals);
    EXPECT_EQ(scene.viewpoint, c.viewpoint);
    EXPECT_TRUE(scene.placeless.empty());
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.parts[0].vertex_count, c.positions.size());
    check_scene(scene);
    EXPECT_EQ(color_bytes(scene), c.colors);
}

INSTANTIATE_TEST_SUITE_P(All, Cloud, testing::ValuesIn(clouds()),
                         [](const auto& test) { return word_of(test.param.name); });

TEST(CloudReader, PointsThatAreNowhereAreKeptAndTold)
{
    const TemporaryFolder folder;
    const std::string rows = "nan nan nan\n1 2 3\n4 5 6\ninf 0 1e200\n";
    for (const std::filesystem::path& path :
         {folder.file("a.pcd", pcd_header(kXyzFields, 4, "ascii") + rows),
          folder.file("a.ply", ply_cloud("element vertex 4\nproperty float x\nproperty float y\n"
                                         "property float z\n",
                                         rows))}) {
        const Scene scene = read_scene(path);
        EXPECT_EQ(scene.positions, (Places{{1, 2, 3}, {1, 2, 3}, {4, 5, 6}, {1, 2, 3}}));
        EXPECT_EQ(scene.placeless, (std::vector<std::uint32_t>{0, 3}));
        ASSERT_EQ(scene.notes.size(), 1u);
        EXPECT_TRUE(scene.notes[0].starts_with("2 points without a finite place"));
    }
}

TEST(CloudReader, ColumnsAreToldForTextAlone)
{
    const TemporaryFolder folder;
    const std::filesystem::path text = folder.file("a.xyz", "1 2 3\n");
    for (const char* columns : {"x y", "x y z z", "- - -", ","})
        EXPECT_THROW(static_cast<void>(read_scene(text, {columns})), SettingsError) << columns;
    const std::filesystem::path obj = folder.file("a.obj", "v 1 2 3\n");
    EXPECT_THROW(static_cast<void>(read_scene(obj, {"x y z"})), SettingsError);
}

}  // namespace
}  // namespace surfelao
