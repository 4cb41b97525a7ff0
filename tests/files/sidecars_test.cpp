#include "files/sidecars.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace surfelao {
namespace {

std::set<std::string> names_of(const std::filesystem::path& mesh)
{
    std::set<std::string> names;
    for (const std::filesystem::path& file : sidecars_of(mesh))
        names.insert(std::filesystem::relative(file, mesh.parent_path()).string());
    return names;
}

TEST(Sidecars, OfObjAreItsMaterialsAndTheirTextures)
{
    const TemporaryFolder folder;
    for (const char* file : {"a.mtl", "b c.mtl", "wood.png", "my bump.png", "unused.png"})
        folder.file(file, "");
    folder.file("a.mtl", "newmtl unused.png\nmap_Kd -s 1 1 1 wood.png\n  bump my bump.png\r\n");
    const auto mesh = folder.file("in.obj", "mtllib a.mtl missing.mtl\r\nv 0 0 0\nmtllib b c.mtl");
    EXPECT_EQ(names_of(mesh),
              (std::set<std::string>{"a.mtl", "b c.mtl", "wood.png", "my bump.png"}));
}

TEST(Sidecars, OfGltfAreAllItsUris)
{
    const TemporaryFolder folder;
    const std::string json =
        R"({"buffers":[{"uri":"a%20b.bin"},{"uri":"data:;base64,AA"}],"images":[{"uri":"t.png"}]})";
    EXPECT_EQ(names_of(folder.file("in.gltf", json)), (std::set<std::string>{"a b.bin", "t.png"}));
    const std::string size(1, static_cast<char>(json.size()));
    EXPECT_EQ(names_of(folder.file("in.glb", std::string("glTF\2\0\0\0xxxx", 12) + size +
                                                 std::string("\0\0\0JSON", 7) + json)),
              (std::set<std::string>{"a b.bin", "t.png"}));
}

TEST(Sidecars, OfPlyAreItsTextureComments)
{
    const TemporaryFolder folder;
    folder.file("t.png", "");
    EXPECT_EQ(names_of(folder.file("in.ply", "ply\ncomment TextureFile t.png\nend_header\n")),
              (std::set<std::string>{"t.png"}));
}

// The longest run of words that is a file is a name; what is not there and what is absolute stays.
TEST(Sidecars, NamesAreFoundFromAnotherFolder)
{
    const TemporaryFolder folder;
    for (const char* name : {"in", "in/sub", "an out", "an out/deep"})
        std::filesystem::create_directory(folder / name);
    for (const char* name : {"in/a.mtl", "in/b c.mtl", "in/sub/d.mtl"})
        folder.file(name, "");
    const auto in = folder / "in", out = folder / "an out", deep = folder / "an out/deep";
    const std::string absolute = (folder / "in/a.mtl").string();
    const std::string names = " a.mtl  none.mtl b c.mtl\tsub\\d.mtl " + absolute;
    std::vector<std::string> missing;
    const std::string there = names_from(out, in, names, missing);
    EXPECT_EQ(there, " ../in/a.mtl  none.mtl ../in/b c.mtl\t../in/sub/d.mtl " + absolute);
    EXPECT_EQ(missing, (std::vector<std::string>{"none.mtl"}));
    // from there on, and back
    EXPECT_EQ(names_from(deep, out, there, missing),
              " ../../in/a.mtl  none.mtl ../../in/b c.mtl\t../../in/sub/d.mtl " + absolute);
    EXPECT_EQ(names_from(in, out, there, missing),
              " a.mtl  none.mtl b c.mtl\tsub/d.mtl " + absolute);
    EXPECT_EQ(path_from(in, out / "x y.png"), "../an out/x y.png");
    // a result whose name has no folder stands in the current one
    EXPECT_EQ(path_from("", std::filesystem::current_path() / "x y.png"), "x y.png");
}

TEST(Sidecars, NoneForWhatCannotBeRead)
{
    const TemporaryFolder folder;
    for (const char* file : {"x.obj", "x.gltf", "x.glb", "x.ply", "x.stl"}) {
        EXPECT_TRUE(sidecars_of(folder / file).empty()) << file;
        EXPECT_TRUE(sidecars_of(folder.file(file, std::string("glTF\0{[[[", 9))).empty()) << file;
    }
    EXPECT_TRUE(sidecars_of(folder.path()).empty());
}

}  // namespace
}  // namespace surfelao
