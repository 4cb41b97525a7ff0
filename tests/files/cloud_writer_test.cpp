// Results of clouds: what is added to the file, what becomes of it in another format.
#include "files/maker_mark.h"
#include "files/obj_io.h"
#include "files/off_io.h"
#include "files/pcd_io.h"
#include "files/ply_io.h"
#include "files/scene_io.h"
#include "files/xyz_io.h"
#include "surfels/errors.h"

#include "cloud_cases.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <functional>

namespace surfelao {
namespace {

using namespace test;

std::vector<Occlusion> halves(const Scene& scene)
{
    return std::vector<Occlusion>(scene.positions.size(), {0.5f, {0, 0, 1}});
}

/// A format in memory.
struct Format {
    std::string extension;
    std::function<Scene(std::string)> read;
    std::function<WrittenFile(const Scene&, std::span<const Occlusion>, const WriteOptions&)> write;
};

std::vector<Format> formats()
{
    return {
        {"ply", [](auto text) { return read_ply("a.ply", text); },
         [](auto&&... rest) { return ply_contents("a.ply", rest...); }},
        {"pcd", [](auto text) { return read_pcd("a.pcd", text); }, pcd_contents},
        {"xyz", [](auto text) { return read_xyz("a.xyz", text); },
         [](auto&&... rest) { return xyz_contents("a.xyz", rest...); }},
        {"pts", [](auto text) { return read_xyz("a.pts", text); },
         [](auto&&... rest) { return xyz_contents("a.pts", rest...); }},
        {"off", [](auto text) { return read_off("a.off", text); }, off_contents},
        {"obj", [](auto text) { return read_obj("a.obj", text); },
         [](auto&&... rest) { return obj_contents("a.obj", rest...); }},
    };
}

std::string baked(const Format& format, const Scene& scene, VertexColors colors)
{
    return format
        .write(scene, halves(scene),
               {colors, Encoding::automatic, make_mark("bake", "colors=" + name_of(colors))})
        .contents;
}

class CloudResult : public testing::TestWithParam<CloudCase> {};

TEST_P(CloudResult, GoesIntoEveryFormat)
{
    const CloudCase& c = GetParam();
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file(c.name, c.contents), {c.columns});
    for (const Format& format : formats()) {
        SCOPED_TRACE(format.extension);
        const std::string result = baked(format, scene, VertexColors::keep);
        const Scene again = format.read(result);
        EXPECT_EQ(again.positions, c.positions);
        EXPECT_TRUE(again.triangles.empty());
        EXPECT_EQ(color_bytes(again), c.colors);
        const bool is_of_clouds = format.extension[0] != 'o';
        EXPECT_EQ(again.normals.values, is_of_clouds ? c.normals : again.normals.values);
        const bool has_viewpoint = format.extension == "ply" || format.extension == "pcd";
        EXPECT_EQ(again.viewpoint, has_viewpoint ? c.viewpoint : std::nullopt);
        // a bake of a bake is a bake of the original
        const Scene shaded = format.read(baked(format, scene, VertexColors::shaded));
        EXPECT_EQ(baked(format, shaded, VertexColors::keep), result);
    }
}

INSTANTIATE_TEST_SUITE_P(All, CloudResult, testing::ValuesIn(clouds()),
                         [](const auto& test) { return word_of(test.param.name); });

/// A file, how it is baked, and the result.
struct Written {
    std::string name, contents;
    VertexColors colors;
    std::string output, result;
};

TEST(CloudWriter, NothingElseOfTheFileChanges)
{
    const std::string mark = "# " + make_mark("bake", "x") + "\n";
    const std::string measured = "occlusion bent_nx bent_ny bent_nz";
    const Written files[] = {
        {"a.xyz", "# hello\n1.50 2 3\n\n4 5 6 # six", VertexColors::keep, "out.xyz",
         "# hello\n1.50 2 3 0.5 0 0 1\n\n4 5 6 0.5 0 0 1 # six\n# columns x y z " + measured +
             "\n" + mark},
        {"a.txt", "X;Y;Z;R;G;B\r\n1;2;3;255;0;0\r\n4;5;6;0;128;7;\r\n", VertexColors::grey,
         "out.txt",
         "X;Y;Z;R;G;B;occlusion;bent_nx;bent_ny;bent_nz;own_red;own_green;own_blue\r\n"
         "1;2;3;188;188;188;0.5;0;0;1;255;0;0\r\n4;5;6;188;188;188;0.5;0;0;1;0;128;7;\r\n" +
             mark.substr(0, mark.size() - 1) + "\r\n"},
        {"a.pts", "2\n1 2 3\n4 5 6\n", VertexColors::automatic, "out.pts",
         "2\n1 2 3 0.5 0 0 1 188 188 188\n4 5 6 0.5 0 0 1 188 188 188\n# columns x y z " +
             measured + " red green blue\n" + mark},
        {"b.xyz", "1 2 3\n4 5 6\n", VertexColors::keep, "out.pts",
         "2\n1 2 3 0.5 0 0 1\n4 5 6 0.5 0 0 1\n# columns x y z " + measured + "\n" + mark},
        {"a.ply",
         ply_cloud("element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                   "property int label\n",
                   "1 2 3 7\n"),
         VertexColors::keep, "out.xyz",
         "1 2 3 7 0.5 0 0 1\n# columns x y z label " + measured + "\n" + mark},
        {"a.pcd",
         pcd_header("FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n", 1, "ascii") +
             "1 2 3 16711680\n",
         VertexColors::grey, "out.pcd",
         "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\n" + mark +
             "FIELDS x y z rgb occlusion bent_nx bent_ny bent_nz own_rgb\n"
             "SIZE 4 4 4 4 4 4 4 4 4\nTYPE F F F U F F F F U\nCOUNT 1 1 1 1 1 1 1 1 1\n"
             "WIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n"
             "1 2 3 12369084 0.5 0 0 1 16711680\n"},
    };
    for (const Written& file : files) {
        const TemporaryFolder folder;
        const Scene scene = read_scene(folder.file(file.name, file.contents));
        write_scene(folder / file.output, scene, halves(scene),
                    {file.colors, Encoding::automatic, make_mark("bake", "x")});
        EXPECT_EQ(contents_of(folder / file.output), file.result) << file.name;
    }
}

TEST(CloudWriter, WhatIsToldIsOfTheFileBeforeItsResult)
{
    const Format text = formats()[2];
    const Scene scene = read_xyz("a.xyz", "9 1 2 3\n9 4 5 6\n", "a x y z");
    const std::string once = baked(text, scene, VertexColors::grey);
    EXPECT_EQ(baked(text, read_xyz("a.xyz", once, "a x y z"), VertexColors::grey), once);
}

TEST(CloudWriter, PointsThatAreNowhereStayWhereTheFormatHasThem)
{
    const Scene scene =
        read_pcd("a.pcd", pcd_header(kXyzFields, 3, "ascii") + "nan nan nan\n1 2 3\n4 5 6\n");
    for (const Format& format : formats()) {
        const Scene again = format.read(baked(format, scene, VertexColors::keep));
        const bool has_them = format.extension == "ply" || format.extension == "pcd";
        EXPECT_EQ(again.placeless.size(), has_them ? 1u : 0u) << format.extension;
    }
    const Format pts = formats()[3];
    EXPECT_EQ(pts.read(baked(pts, scene, VertexColors::keep)).positions,
              (Places{{1, 2, 3}, {4, 5, 6}}));
}

TEST(CloudWriter, AResultIsKnownByItsMark)
{
    const TemporaryFolder folder;
    const Scene scene = read_xyz("a.xyz", "1 2 3\n");
    const std::string mark = make_mark("bake", "x");
    for (const char* name : {"a.xyz", "a.pts", "a.txt", "a.asc", "a.pcd", "a.ply"}) {
        write_scene(folder / name, scene, halves(scene), {.mark = mark});
        EXPECT_EQ(read_mark(folder / name), mark) << name;
    }
}

TEST(CloudWriter, MeshesAreNoPoints)
{
    const TemporaryFolder folder;
    const Scene mesh = read_scene(folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    for (const char* name : {"out.xyz", "out.txt", "out.pcd"}) {
        const std::filesystem::path output = folder / name;
        EXPECT_THROW(write_scene(output, mesh, halves(mesh)), InputError) << name;
        EXPECT_THROW(check_output("a.stl", output), InputError) << name;
        EXPECT_THROW(check_output("a.glb", output), InputError) << name;
        EXPECT_FALSE(std::filesystem::exists(output));
        check_output("a.ply", output);
    }
}

}  // namespace
}  // namespace surfelao
