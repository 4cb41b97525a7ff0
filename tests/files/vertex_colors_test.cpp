#include "files/vertex_colors.h"

#include "files/maker_mark.h"
#include "files/ply_io.h"
#include "files/scene_io.h"

#include "surfels/srgb.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

constexpr VertexColors kAll[] = {VertexColors::automatic, VertexColors::grey, VertexColors::shaded,
                                 VertexColors::keep, VertexColors::bent};

/// Three vertices, whose visibilities are 1/4, 1/2 and 1.
const std::vector<Occlusion> kAnswers = {
    {0.75f, {0.6f, -0.8f, 0.0f}}, {0.5f, {0.0f, 0.0f, 1.0f}}, {0.0f, {0.0f, 1.0f, 0.0f}}};

/// As bake() asks.
WriteOptions options_of(VertexColors colors, Encoding encoding = Encoding::automatic)
{
    return {colors, encoding,
            make_mark("bake", "colors=" + name_of(colors) + " encoding=" + name_of(encoding))};
}

// ---- files with colours of their own ------------------------------------------------------------

std::string ascii_ply(const std::string& properties, const std::array<std::string, 3>& rows)
{
    return "ply\nformat ascii 1.0\nelement vertex 3\n" + properties +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + rows[0] + "\n" +
           rows[1] + "\n" + rows[2] + "\n3 0 1 2\n";
}

const std::string kPlace = "property float x\nproperty float y\nproperty float z\n";
const std::string kBytes = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

/// Colours of two bytes and alpha in front of the coordinates.
std::string big_endian_ply()
{
    std::string text =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty ushort diffuse_red\n"
        "property ushort diffuse_green\nproperty uchar alpha\nproperty ushort diffuse_blue\n" +
        kPlace + "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::uint32_t v = 0; v < 3; ++v) {
        for (const std::uint16_t number : {std::uint16_t(700 * v), std::uint16_t(65535)})
            append_bytes(text, number, std::endian::big);
        text += '\x80';
        append_bytes(text, std::uint16_t(300), std::endian::big);
        for (const float axis : {v == 1 ? 1.0f : 0.0f, v == 2 ? 1.0f : 0.0f, 0.0f})
            append_bytes(text, axis, std::endian::big);
    }
    text += '\3';
    for (const std::uint32_t corner : {0u, 1u, 2u})
        append_bytes(text, corner, std::endian::big);
    return text;
}

struct SourceFile {
    const char* name;
    std::string contents;
};

std::vector<SourceFile> plain_files()
{
    return {{"plain.obj", "v 0 0 0\r\nv 1 0 0 2\r\nv 0 1 0 # last\r\nf 1 2 3"},
            {"plain.off", "3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
            {"plain.ply", ascii_ply(kPlace, {"0 0 0", "1 0 0", "0 1 0"})}};
}

std::vector<SourceFile> coloured_files()
{
    return {
        {"unit.obj", "v 0 0 0 .8 .20 1\nv 1 0 0\t.8  .5 0\nv 0 1 0\nvt 0 0\nf 1 2 3\n"},
        {"bytes.obj", "v 0 0 0 8 200 255 128\r\nv 1 0 0 1 1 nan 255\r\nv 0 1 0 0 0 0 0\r\nf 1 2 3"},
        {"unit.off",
         "OFF # of floats\n3 1 0\n0 0 0 .5 .5 .25 .5\n1 0 0 1 1 1 1 # white\n"
         "0 1 0 0 0 0 0\n3 0 1 2 255 0 0\n"},
        {"bytes.off",
         "STCNOFF 3 1 0\n0 0 0 0 0 1 9 8 7 255 .5 .5\n1 0 0 0 0 1 90 80 70 1 0 0\n"
         "0 1 0 0 0 1 255 255 255 0 1 1\n3 0 1 2"},
        {"bytes.ply", ascii_ply(kPlace + kBytes + "property uchar alpha\n",
                                {"0 0 0 200 40 30  7", "1 0 0 255 255 0 8", "0 1 0 1 2 3 9"})},
        {"unit.ply",
         ascii_ply("property float red\nproperty float green\nproperty float blue\n" + kPlace,
                   {".50 .2 1 0 0 0", "nan  0 0 1 0 0", "1 1 1 0 1 0"})},
        {"two_bytes.ply", big_endian_ply()},
        {"white.ply", ascii_ply(kPlace + kBytes,
                                {"0 0 0 255 255 255", "1 0 0 255 255 255", "0 1 0 255 255 255"})}};
}

// ---- what becomes of them -----------------------------------------------------------------------

class VertexColorsTest : public testing::Test {
protected:
    /// The result's text, and its notes, for a file of these contents.
    std::string result(const std::string& name, const std::string& contents,
                       const WriteOptions& options)
    {
        const fs::path in = folder_.file("in_" + name, contents), out = folder_ / name;
        notes_ = write_scene(out, read_scene(in), kAnswers, options);
        return contents_of(out);
    }
    std::string result(const SourceFile& file, const WriteOptions& options)
    {
        return result(file.name, file.contents, options);
    }
    TemporaryFolder folder_;
    std::vector<std::string> notes_;
};

TEST_F(VertexColorsTest, AQuarterOfTheLightIsAQuarterInAReaderOfTheFormat)
{
    EXPECT_NEAR(srgb_decode(0.537099f), 0.25f, 1e-6f);
    EXPECT_NEAR(srgb_decode(137.0f / 255.0f), 0.25f, 0.5f / 255.0f);
    const std::string first[] = {"v 0 0 0 ", "\n0 0 0 ", "\n0 0 0 0.75 0.6 -0.8 0 "};
    const std::string srgb[] = {"0.537099 0.537099 0.537099\r\n", "137 137 137 255\n",
                                "137 137 137\n"};
    const std::string linear[] = {"0.250000 0.250000 0.250000\r\n", "64 64 64 255\n", "64 64 64\n"};
    std::size_t format = 0;
    for (const SourceFile& file : plain_files()) {
        for (const VertexColors colors :
             {VertexColors::automatic, VertexColors::grey, VertexColors::shaded}) {
            for (const Encoding encoding :
                 {Encoding::automatic, Encoding::srgb, Encoding::linear}) {
                const std::string text = result(file, options_of(colors, encoding));
                const auto& numbers = encoding == Encoding::linear ? linear : srgb;
                EXPECT_NE(text.find(first[format] + numbers[format]), text.npos) << text;
                EXPECT_EQ(notes_, std::vector<std::string>());
            }
        }
        ++format;
    }
}

// 0.25 * srgb_decode(0.5) is 0.0535, of which sRGB makes 0.2565; bent normals are 0.5 + 0.5 n.
TEST_F(VertexColorsTest, OwnColoursAreKeptShadedOrReplaced)
{
    struct Expected {
        SourceFile file;
        VertexColors colors;
        std::vector<std::string> lines;
    };
    const std::string obj = "v 0 0 0 .5 1.0  0\nv 1 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n";
    const std::string off = "OFF\n3 1 0\n0 0 0 .5 1 0 .5\n1 0 0\n0 1 0 1 1 1 1\n3 0 1 2\n";
    const std::string ply = ascii_ply(kPlace + kBytes + "property uchar alpha\n",
                                      {"0 0 0 200  0 255 9", "1 0 0 0 0 0 9", "0 1 0 1 2 3 9"});
    const std::string real = ascii_ply(
        "property float red\nproperty float green\n"
        "property float blue\n" +
            kPlace,
        {".50 0 1 0 0 0", "0 0 0 1 0 0", "1 1 1 0 1 0"});
    const Expected cases[] = {
        {{"a.obj", obj},
         VertexColors::automatic,
         {"v 0 0 0 0.256483 0.537099 0.000000", "v 1 0 0 0.735357 0.735357 0.735357",
          "v 0 1 0 1.000000 1.000000 1.000000", "f 1 2 3", "# own .5 1.0 0", "# own",
          "# own 1 1 1"}},
        {{"a.obj", obj},
         VertexColors::keep,
         {"v 0 0 0 .5 1.0 0", "v 1 0 0", "v 0 1 0 1 1 1", "f 1 2 3"}},
        {{"a.obj", obj}, VertexColors::bent, {"v 0 0 0 0.906332 0.349190 0.735357"}},
        {{"a.off", off},
         VertexColors::automatic,
         {"COFF", "0 0 0 65 137 0 128", "1 0 0 188 188 188 255", "0 1 0 255 255 255 255",
          "# own .5 1 0 .5", "# own", "# own 1 1 1 1"}},
        {{"a.off", off},
         VertexColors::keep,
         {"COFF", "0 0 0 .5 1 0 .5", "1 0 0", "0 1 0 1 1 1 1", "3 0 1 2"}},
        {{"alpha.obj", "v 0 0 0 51 0 0 99\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
         VertexColors::bent,
         {"v 0 0 0 0.906332 0.349190 0.735357 99", "# own 51 0 0 99"}},
        {{"plain.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
         VertexColors::keep,
         {"OFF", "3 1 0", "0 0 0"}},
        {{"normals.off", "NOFF\n3 1 0\n0 0 0\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"},
         VertexColors::grey,
         {"CNOFF", "0 0 0 0 0 0 137 137 137 255", "1 0 0 0 0 1 188 188 188 255"}},
        {{"a.ply", ply}, VertexColors::automatic, {"0 0 0 200  0 255 9 0.75 0.6 -0.8 0"}},
        {{"a.ply", ply},
         VertexColors::grey,
         {"property float bent_nz", "property uchar own_red", "property uchar own_green",
          "property uchar own_blue", "0 0 0 137  137 137 9 0.75 0.6 -0.8 0 200 0 255"}},
        {{"a.ply", real},
         VertexColors::shaded,
         {"property float own_blue", "0.25648323 0 0.5370987 0 0 0 0.75 0.6 -0.8 0 .50 0 1"}},
    };
    for (const Expected& c : cases) {
        std::istringstream stream(result(c.file, options_of(c.colors)));
        std::vector<std::string> lines;
        for (std::string line; std::getline(stream, line);)
            lines.push_back(line);
        auto at = lines.begin();
        for (const std::string& line : c.lines) {
            at = std::find(at, lines.end(), line);
            EXPECT_NE(at, lines.end()) << line << " in " << stream.str();
        }
    }
}

// Also where the first bake was asked for other colours: no colour is lost, and none is left over.
TEST_F(VertexColorsTest, ABakeOfABakeIsABakeOfTheOriginal)
{
    std::vector<SourceFile> files = plain_files();
    for (const SourceFile& file : coloured_files())
        files.push_back(file);
    // ends as a result would that keeps colours, twice over, but has none
    files.push_back({"lookalike.obj",
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# own 1 0 0\n# own 1 0 0\n"
                     "# own 1 0 0\n# own 1 0 0\n# own 1 0 0\n# own 1 0 0\n"});
    files.push_back(
        {"lookalike.off",
         "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n# own 1 2 3\n# own 1 2 3\n# own 1 2 3"});
    for (const SourceFile& file : files) {
        std::map<VertexColors, std::string> of_original;
        for (const VertexColors colors : kAll)
            of_original[colors] = result(file, options_of(colors));
        for (const VertexColors first : kAll) {
            for (const VertexColors second : kAll) {
                EXPECT_EQ(result(file.name, of_original[first], options_of(second)),
                          of_original[second])
                    << file.name << ": " << name_of(first) << ", then " << name_of(second);
            }
        }
    }
}

TEST_F(VertexColorsTest, WhatBecameOfOwnColoursIsSaidWhereItMaySurprise)
{
    for (const SourceFile& file : coloured_files()) {
        const std::string name = file.name;
        const bool is_ply = name.ends_with(".ply"), is_white = name.starts_with("white");
        result(file, options_of(VertexColors::automatic));
        ASSERT_EQ(notes_.size(), is_white ? 0u : 1u) << name;
        EXPECT_EQ(!is_white && notes_[0].starts_with("colours of the file kept"),
                  is_ply && !is_white);
        result(file, options_of(VertexColors::keep));
        EXPECT_EQ(notes_.size(), is_ply ? 0u : 1u) << name;
        result(file, options_of(VertexColors::shaded));
        EXPECT_EQ(notes_.size(), 0u) << name;
    }
}

// Colours that a bake made of nothing are nobody's; of another program they are the file's.
TEST_F(VertexColorsTest, TheMarkTellsWhoseColoursTheyAre)
{
    for (const SourceFile& file : plain_files()) {
        const std::string grey = result(file, options_of(VertexColors::grey));
        const WriteOptions bare = {VertexColors::grey, Encoding::automatic, ""};
        EXPECT_EQ(result(file.name, grey, bare), result(file, bare)) << file.name;
    }
    const std::string unmarked = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n";
    const std::string shaded = result("a.obj", unmarked, {});
    EXPECT_NE(shaded.find("# own 1 0 0"), shaded.npos) << shaded;
}

// From a PLY to an OBJ and back the colours are the same.
TEST_F(VertexColorsTest, OwnColoursGoIntoOtherFormats)
{
    const std::string ply =
        ascii_ply(kPlace + kBytes, {"0 0 0 200 40 30", "1 0 0 1 2 3", "0 1 0 255 0 0"});
    const Scene scene = read_scene(folder_.file("in.ply", ply));
    write_scene(folder_ / "out.off", scene, kAnswers, options_of(VertexColors::shaded));
    write_scene(folder_ / "out.obj", read_scene(folder_ / "out.off"), kAnswers,
                options_of(VertexColors::grey));
    write_scene(folder_ / "out.ply", read_scene(folder_ / "out.obj"), kAnswers,
                options_of(VertexColors::keep));
    EXPECT_NE(contents_of(folder_ / "out.off").find("\n# own 200 40 30 255\n"), std::string::npos);
    const Scene again = read_scene(folder_ / "out.ply");
    ASSERT_EQ(again.asset->own_colors().size(), 3u);
    EXPECT_EQ(again.asset->own_colors(), scene.asset->own_colors());
}

TEST_F(VertexColorsTest, OtherFilesAreFoundFromAResultInAnotherFolder)
{
    const std::string ply =
        ascii_ply("comment TextureFile my t.png\n" + kPlace, {"0 0 0", "1 0 0", "0 1 0"});
    const SourceFile files[] = {
        {"a.obj", "mtllib a b.mtl none.mtl # both\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
        {"a.ply", ply}};
    const std::string lines[] = {"mtllib ../in/a b.mtl none.mtl # both\n",
                                 "comment TextureFile ../in/my t.png\n"};
    for (const char* name : {"in", "out", "third"})
        fs::create_directory(folder_ / name);
    folder_.file("in/a b.mtl", "");
    folder_.file("in/my t.png", "");
    std::size_t i = 0;
    for (const SourceFile& file : files) {
        const std::string name = file.name;
        const auto bake = [&](const std::string& from, const std::string& to) {
            notes_ = write_scene(folder_ / (to + name), read_scene(folder_ / (from + name)),
                                 kAnswers, options_of(VertexColors::automatic));
            return contents_of(folder_ / (to + name));
        };
        folder_.file("in/" + name, file.contents);
        const std::string moved = bake("in/", "out/");
        EXPECT_NE(moved.find(lines[i]), moved.npos) << moved;
        EXPECT_EQ(notes_.size(), name == "a.obj" ? 1u : 0u);
        EXPECT_EQ(bake("out/", "third/"), moved);
        // back, and beside the original, the names are those of the original
        EXPECT_EQ(bake("out/", "in/x"), bake("in/", "in/y"));
        ++i;
    }
}

}  // namespace
}  // namespace surfelao
