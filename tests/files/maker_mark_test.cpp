#include "files/maker_mark.h"

#include "files/gltf_io.h"
#include "files/obj_io.h"
#include "files/off_io.h"
#include "files/ply_io.h"
#include "gltf_maker.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

const std::string kMark = make_mark("bake", "engine=masks quality=1");
const std::string kOther = make_mark("bake", "engine=disks");
constexpr const char* kTriangleObj = "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n";

/// Reads the file and writes it with the mark under the name.
std::filesystem::path marked(const std::filesystem::path& from, const std::filesystem::path& to,
                             const std::string& mark)
{
    const Scene scene = read_scene(from);
    const std::vector<Occlusion> occlusion(scene.positions.size());
    WriteOptions options;
    options.mark = mark;
    write_scene(to, scene, occlusion, options);
    return to;
}

TEST(MakerMark, IsTextOfOneForm)
{
    EXPECT_EQ(command_of_mark(kMark), "bake");
    for (const char* text :
         {"", "surfelao", "surfelao ", "surfelao rocks", "surfelao is: good", "surfelao 1 a b: c",
          "surfelao 1 bake:x", "made by surfelao 1 bake: x", "surfelao 1 bake: x\ny"})
        EXPECT_EQ(command_of_mark(text), "") << text;
}

TEST(MakerMark, IsReadBackFromEveryFormatAndTakesTheOldOnesPlace)
{
    const TemporaryFolder folder;
    const test::GltfMaker maker = test::one_triangle();
    folder.file("in.obj", kTriangleObj);
    folder.file("in.glb", maker.glb());
    for (const char* name : {"x.ply", "x.obj", "x.off", "x.glb", "x.gltf"}) {
        const bool gltf = std::string(name).find(".gl") != std::string::npos;
        const auto first = marked(folder / (gltf ? "in.glb" : "in.obj"), folder / name, kMark);
        EXPECT_EQ(read_mark(first), kMark) << name;
        const auto second = marked(first, folder / (std::string("2") + name), kOther);
        EXPECT_EQ(read_mark(second), kOther) << name;
        EXPECT_EQ(contents_of(second).find(kMark), std::string::npos) << name;
        const auto third = marked(second, folder / (std::string("3") + name), "");
        EXPECT_EQ(read_mark(third), "") << name;
        EXPECT_EQ(contents_of(third).find(kOther), std::string::npos) << name;
    }
}

// Without its mark a file is what it was before there were marks.
TEST(MakerMark, ChangesNothingElse)
{
    const TemporaryFolder folder;
    folder.file("in.obj", "\xEF\xBB\xBF" + std::string(kTriangleObj));
    folder.file("in.ply",
                "ply\r\ncomment a\r\nformat ascii 1.0\r\ncomment surfelao rocks\r\n"
                "element vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
                "comment between\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
                "end_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n");
    const auto line = [](const char* name, const std::string& mark) {
        return std::string(name) == "x.ply"   ? "comment " + mark + "\r\n"
               : std::string(name) == "x.obj" ? "# " + mark + "\r\n"
                                              : "# " + mark + "\n";
    };
    for (const auto& [in, out] :
         {std::pair("in.ply", "x.ply"), {"in.obj", "x.obj"}, {"in.obj", "x.off"}}) {
        std::string with = contents_of(marked(folder / in, folder / out, kMark));
        const std::string without = contents_of(marked(folder / in, folder / out, ""));
        const std::size_t at = with.find(line(out, kMark));
        ASSERT_NE(at, std::string::npos) << with;
        EXPECT_EQ(with.erase(at, line(out, kMark).size()), without) << out;
    }
}

// The old values go, with their bytes.
TEST(MakerMark, BakingTwiceGivesTheFileOfBakingOnce)
{
    const TemporaryFolder folder;
    test::GltfMaker maker = test::square();
    maker.add("nodes", {{"mesh", 0}, {"translation", {0, 0, 1}}});  // its mesh is copied
    maker.document["scenes"][0]["nodes"] = {0, 1};
    folder.file("in.glb", maker.glb());
    folder.file("in.gltf", test::one_triangle().gltf(test::kTriangleUri));
    folder.file("in.obj", kTriangleObj);
    for (const auto& [in, out] : {std::pair("in.glb", "x.glb"),
                                  {"in.glb", "x.gltf"},
                                  {"in.gltf", "x.gltf"},
                                  {"in.obj", "x.ply"},
                                  {"in.obj", "x.obj"},
                                  {"in.obj", "x.off"}}) {
        const std::string once = contents_of(marked(folder / in, folder / out, kMark));
        const std::string other = contents_of(marked(folder / out, folder / out, kOther));
        EXPECT_NE(other, once) << out;
        EXPECT_EQ(contents_of(marked(folder / out, folder / out, kMark)), once) << in << ' ' << out;
    }
}

// What another program has put behind them since keeps its place.
TEST(MakerMark, OldValuesStayWhereSomethingElseUsesTheirBytes)
{
    const TemporaryFolder folder;
    folder.file("in.gltf", test::one_triangle().gltf(test::kTriangleUri));
    marked(folder / "in.gltf", folder / "x.gltf", kMark);
    nlohmann::json document = nlohmann::json::parse(contents_of(folder / "x.gltf"));
    const std::size_t views = document["bufferViews"].size();
    document["images"] = {{{"bufferView", views - 1}, {"mimeType", "image/png"}}};
    folder.file("x.gltf", document.dump());
    marked(folder / "x.gltf", folder / "y.gltf", kMark);
    EXPECT_EQ(nlohmann::json::parse(contents_of(folder / "y.gltf"))["bufferViews"].size(),
              2 * views - 1);
}

TEST(MakerMark, StaysOutOfExtrasThatAreNoObject)
{
    const TemporaryFolder folder;
    test::GltfMaker maker = test::one_triangle();
    maker.document["asset"]["extras"] = {{"author", "me"}};
    marked(folder.file("in.glb", maker.glb()), folder / "x.glb", kMark);
    EXPECT_EQ(read_mark(folder / "x.glb"), kMark);
    EXPECT_NE(contents_of(folder / "x.glb").find("\"author\":\"me\""), std::string::npos);
    maker.document["asset"]["extras"] = 7;
    marked(folder.file("in.glb", maker.glb()), folder / "x.glb", kMark);
    EXPECT_EQ(read_mark(folder / "x.glb"), "");
    EXPECT_NE(contents_of(folder / "x.glb").find("\"extras\":7"), std::string::npos);
}

TEST(MakerMark, IsNotFoundInWhatIsNoSuchFile)
{
    const TemporaryFolder folder;
    for (const char* extension : {".ply", ".obj", ".off", ".gltf", ".glb", ".html", ".txt"}) {
        const std::string name = std::string("x") + extension;
        EXPECT_EQ(read_mark(folder / name), "");
        for (const std::string& contents :
             {std::string(), std::string("glTF"), std::string(1 << 16, '{'),
              std::string("glTF\2\0\0\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFFJSON{", 21),
              std::string(1 << 16, '\0'), std::string(1 << 16, '\n')})
            EXPECT_EQ(read_mark(folder.file(name, contents)), "") << extension;
    }
    EXPECT_EQ(read_mark(folder.path()), "");
}

}  // namespace
}  // namespace surfelao
