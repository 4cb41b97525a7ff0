// Files long enough to be read in ranges by several threads: what they say does not depend on where
// one range ends and the next begins.
#include "files/scene_io.h"
#include "files/text_cursor.h"
#include "surfels/errors.h"

#include "malformed_case.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace surfelao {
namespace {

constexpr std::uint32_t kRows = 120'000;  // of 15 bytes and more: several ranges

std::string digits(std::uint32_t number)
{
    return std::to_string(number);
}

/// Line i has a vertex at x = i; face i uses the vertices i, i + 1 and i + 2.
std::string ascii_ply(const std::string& newline)
{
    std::string text = "ply" + newline + "format ascii 1.0" + newline + "element vertex " +
                       digits(kRows) + newline;
    for (const char* axis : {"x", "y", "z"})
        text += std::string("property float ") + axis + newline;
    text += "element face " + digits(kRows - 2) + newline +
            "property list uchar int vertex_indices" + newline + "end_header" + newline;
    for (std::uint32_t i = 0; i < kRows; ++i)
        text += digits(i) + " 0.25 " + digits(i % 7) + newline;
    for (std::uint32_t i = 0; i + 2 < kRows; ++i)
        text += "3 " + digits(i) + " " + digits(i + 1) + " " + digits(i + 2) + newline;
    return text;
}

/// Index of the first vertex or triangle that is not as in ascii_ply(); the number of rows: none.
std::uint32_t first_wrong(const Scene& scene)
{
    for (std::uint32_t i = 0; i < kRows; ++i) {
        const bool is_right = scene.positions[i] == glm::dvec3(i, 0.25, i % 7) &&
                              (i + 2 >= kRows || scene.triangles[i] == glm::uvec3(i, i + 1, i + 2));
        if (!is_right)
            return i;
    }
    return kRows;
}

Scene read(const std::string& name, const std::string& contents)
{
    const TemporaryFolder folder;
    return read_scene(folder.file(name, contents));
}

std::string replaced(std::string text, const std::string& old, const std::string& by)
{
    return text.replace(text.find(old), old.size(), by);
}

TEST(LargeFile, RowsOfAsciiPlyStandWhereTheyStandInTheFile)
{
    for (const char* newline : {"\n", "\r\n", "\r"}) {
        const Scene scene = read("large.ply", ascii_ply(newline));
        ASSERT_EQ(scene.positions.size(), kRows);
        ASSERT_EQ(scene.triangles.size(), kRows - 2);
        EXPECT_EQ(first_wrong(scene), kRows);
    }
}

TEST(LargeFile, EmptyLinesBetweenRowsCountAsLinesOnly)
{
    const std::string text = replaced(replaced(ascii_ply("\n"), "\n40000 ", "\n\n \t\n40000 "),
                                      "\n3 100000 ", "\n\n\n3 100000 ");
    EXPECT_EQ(first_wrong(read("large.ply", text)), kRows);
}

// Of several faults, the first in the file is told: its row and its line, behind 9 of the header.
TEST(LargeFile, TheFirstFaultOfAsciiPlyIsToldWithItsLine)
{
    const std::string wrong_faces =
        replaced(replaced(ascii_ply("\n"), "\n3 90000 ", "\n3 x "), "\n3 110000 ", "\n3 -9 ");
    malformed::expect_refused({"ply_face", wrong_faces, {"line 210010", "\"x\""}});
    malformed::expect_refused({"ply_vertex",
                               replaced(wrong_faces, "\n77777 ", "\n\n77777 0 "),
                               {"line 77788", "vertex 77777", "more numbers"}});
    std::string cut = ascii_ply("\n");
    cut.resize(cut.find("\n3 119900 ") + 1);
    malformed::expect_refused({"ply_cut", cut, {"face 119900", "is missing"}});
}

/// Triangles, and a quad in place of each hundredth.
std::string binary_ply()
{
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\nelement face " +
        digits(kRows) + "\nproperty list uchar int vertex_indices\nend_header\n";
    text += malformed::bytes(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f);
    for (std::uint32_t i = 0; i < kRows; ++i)
        text += i % 100 == 99 ? malformed::bytes(std::uint8_t{4}, 0, 1, 2, 3)
                              : malformed::bytes(std::uint8_t{3}, 0, 1, i % 2 == 0 ? 2 : 3);
    return text;
}

TEST(LargeFile, RowsOfBinaryPlyMayHaveAnyLength)
{
    const Scene scene = read("large.ply", binary_ply());
    ASSERT_EQ(scene.triangles.size(), kRows + kRows / 100);
    std::uint32_t wrong = 0;
    for (std::uint32_t i = 0, triangle = 0; i < kRows; ++i, ++triangle) {
        const bool is_quad = i % 100 == 99;
        wrong += !is_quad && scene.triangles[triangle] != glm::uvec3(0, 1, i % 2 == 0 ? 2 : 3);
        triangle += is_quad ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u);
}

TEST(LargeFile, TheFirstFaultOfBinaryPlyIsTold)
{
    std::string contents = binary_ply();
    const std::size_t faces = contents.size() - kRows * 13 - kRows / 100 * 4;
    const auto row = [&](std::size_t i) { return faces + i * 13 + i / 100 * 4; };
    contents.resize(contents.size() - 2);
    malformed::expect_refused({"ply_cut", contents, {"face 119999", "is cut"}});
    contents[row(70'000) + 1] = 9;
    malformed::expect_refused({"ply_index", contents, {"face 70000", "uses vertex 9"}});
}

/// The same strip of faces; a group for each 50,000 of them, `vn` for all but the first.
std::string large_obj(bool counts_back)
{
    std::string text = "vn 0 0 1\n";
    for (std::uint32_t i = 0; i < kRows; ++i)
        text += "v " + digits(i) + " 0.25 " + digits(i % 7) + "\n";
    const auto corner = [&](std::uint32_t vertex) {
        return counts_back ? std::to_string(std::int64_t{vertex} - kRows) : digits(vertex + 1);
    };
    for (std::uint32_t i = 0; i + 2 < kRows; ++i) {
        if (i % 50'000 == 0)
            text += "g part" + digits(i / 50'000) + "\n";
        const char* normal = i == 0 ? "" : "//1";
        text += "f " + corner(i) + normal + " \\\n" + corner(i + 1) + normal + " " + corner(i + 2) +
                normal + "\n";
    }
    return text;
}

TEST(LargeFile, LinesOfObjStandWhereTheyStandInTheFile)
{
    for (const bool counts_back : {false, true}) {
        const Scene scene = read("large.obj", large_obj(counts_back));
        ASSERT_EQ(scene.positions.size(), kRows);
        EXPECT_EQ(first_wrong(scene), kRows);
        ASSERT_EQ(scene.normals.corners.size(), kRows - 2);
        EXPECT_EQ(scene.normals.corners.front(), glm::uvec3(CornerNormals::kNone));
        EXPECT_EQ(std::ranges::count(scene.normals.corners, glm::uvec3(0)), kRows - 3);
        ASSERT_EQ(scene.labels.size(), 3u);
        EXPECT_EQ(scene.labels[2].name, "part2");
        EXPECT_EQ(scene.labels[2].ranges,
                  (std::vector<Label::Range>{{100'000, kRows - 2 - 100'000}}));
    }
}

// A face may use what comes later, but nothing that never comes: the first line that does is told.
TEST(LargeFile, TheFirstFaultOfObjIsToldWithItsLine)
{
    std::string text = large_obj(false);
    malformed::expect_refused({"obj_index",
                               text + "f 1 2 200000\nf 1 2 200000\n",
                               {"line 360001", "uses vertex 200000"}});
    text = replaced(text, "\nv 100000 ", "\nv 1e ");
    malformed::expect_refused(
        {"obj_number", replaced(text, "\nf 99/", "\nf 0/"), {"line 100002", "\"1e\""}});
}

TEST(LargeFile, WrittenRowsAreThoseOfTheFileWithWhatIsNew)
{
    const TemporaryFolder folder;
    const std::string text = ascii_ply("\n");
    const Scene scene = read_scene(folder.file("large.ply", text));
    std::vector<Occlusion> occlusion(kRows);
    for (std::uint32_t i = 0; i < kRows; ++i)
        occlusion[i].occlusion = static_cast<float>(i % 1024) / 1024.0f;
    const std::filesystem::path path = folder.path() / "written.ply";
    static_cast<void>(write_scene(path, scene, occlusion, {.colors = VertexColors::keep}));
    std::ifstream file(path, std::ios::binary);
    const std::string written(std::istreambuf_iterator<char>(file), {});
    const std::size_t faces = text.find("\n3 0 1 2\n");
    EXPECT_TRUE(written.ends_with(text.substr(faces)));
    std::size_t at = written.find("end_header\n") + 11, wrong = 0;
    for (std::uint32_t i = 0; i < kRows; ++i) {
        const std::string row = digits(i) + " 0.25 " + digits(i % 7) + " ";
        const std::size_t end = written.find('\n', at);
        const std::string line = written.substr(at, end - at);
        wrong += !line.starts_with(row) ||
                 std::strtof(line.c_str() + row.size(), nullptr) != occlusion[i].occlusion;
        at = end + 1;
    }
    EXPECT_EQ(wrong, 0u);

    // three times as long, and so more ranges than two cores take at once
    static_cast<void>(
        write_scene(path, read_scene(path), occlusion, {.colors = VertexColors::keep}));
    std::ifstream again(path, std::ios::binary);
    EXPECT_TRUE(std::string(std::istreambuf_iterator<char>(again), {}) == written);
}

// Short decimal numbers do not go through the library: strtod is the oracle, to the last bit.
TEST(TextCursor, DecimalNumbersAreRightToTheLastBit)
{
    std::mt19937 random(1);
    std::string text;
    for (int i = 0; i < 50'000; ++i) {
        text += random() % 2 == 0 ? "-" : "";
        const std::size_t before = random() % 12, behind = random() % 26;
        for (std::size_t k = 0; k < before; ++k)
            text += static_cast<char>('0' + random() % 10);
        text += before == 0 || random() % 4 > 0 ? "." : "";
        for (std::size_t k = 0; k < std::max<std::size_t>(behind, 1); ++k)
            text += static_cast<char>('0' + (random() % 3 == 0 ? 0 : random() % 10));
        text += random() % 8 == 0 ? "e-3 " : " ";
    }
    text += "-0 9007199254740993 9007199254740992.0 .5 5. 0.0000000000000000000000001";
    TextCursor cursor("numbers", text, {});
    ASSERT_TRUE(cursor.next_line());
    const char* oracle = text.c_str();
    std::size_t wrong = 0;
    while (!cursor.at_line_end()) {
        char* end = nullptr;
        const double expected = std::strtod(oracle, &end);
        oracle = end;
        wrong += std::bit_cast<std::uint64_t>(cursor.number("a number")) !=
                 std::bit_cast<std::uint64_t>(expected);
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(*oracle, '\0');
}

}  // namespace
}  // namespace surfelao
