// Files that break their format's rules and leave no doubt what they show: read, and each lapse
// counted in a note.
#include "files/gltf_uri.h"
#include "files/scene_io.h"
#include "surfels/geometry.h"

#include "gltf_maker.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <limits>
#include <ostream>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;

using Notes = std::vector<std::string>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// ---- OBJ, PLY, OFF, STL
// --------------------------------------------------------------------------

/// All of them show one triangle.
struct Trifle {
    std::string name;  ///< of the test; the part up to the first '_' is the file's extension
    std::string contents;
    Notes notes;

    friend std::ostream& operator<<(std::ostream& out, const Trifle& t) { return out << t.name; }
};

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kRows = "0 0 0\n1 0 0\n0 1 0\n";

/// vertex_rows and face_rows: as many as the header says.
std::string ply(int vertices, int faces, const std::string& rows)
{
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
           std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n" + rows;
}

std::string facet(const std::string& end_loop = "endloop", const std::string& end = "endfacet")
{
    return "facet normal nan 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n" +
           end_loop + '\n' + end + '\n';
}

std::string binary_stl(std::string header, const std::string& behind)
{
    header.resize(80, '\0');
    return header + bytes_of<std::uint32_t>({1}) +
           bytes_of<float>({kNaN, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string(2, '\0') + behind;
}

Notes small_faces(int count)
{
    return {std::to_string(count) + (count == 1 ? " face" : " faces") +
            " of fewer than three corners passed over"};
}

// long: a table
std::vector<Trifle> trifles()
{
    const Notes placed{"1 vertex without a finite place, but in no face, passed over"};
    const Notes two_words{"1 keyword in two words, as \"end loop\""};
    std::vector<Trifle> all{
        {"obj_SmallFaces", kObj + "f 1 2\nf 1 2 3\nf 2\nf\n", small_faces(3)},
        {"obj_SmallFaceWithNormals", kObj + "vn 0 0 1\nf 1 2 3\nf 1//1 2//1\nl 1 2\n",
         small_faces(1)},
        {"obj_NoNormals",
         kObj + "f 1//1 2//2 3//3\n",
         {"3 corners of faces with a normal that the file does not have: taken as without"}},
        {"obj_NanColour", kObj.substr(0, 7) + " nan nan nan\n" + kObj.substr(8) + "f 1 2 3\n", {}},
        {"obj_TextureOutOfRange",
         kObj + "f 1/7 2/0 3/-9\n",
         {"3 corners of faces with a texture coordinate that the file does not have: taken as "
          "without"}},
        {"obj_TextureIsNoNumber", kObj + "vt up\nvt 1 1.#IND left\nvt\nf 1/1 2/2 3/3\n", {}},
        {"ply_OddTexcoord",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int "
         "z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float "
         "texcoord\nend_header\n" +
             kRows + "3 0 1 2 5 0 0 1 0 1\n",
         {"1 face with a list texcoord that has not two numbers for each corner: taken as "
          "without"}},
        {"ply_SmallFaces", ply(3, 4, kRows + "2 0 1\n3 0 1 2\n1 2\n0\n"), small_faces(3)},
        {"off_SmallFaces", "OFF 3 3 0\n" + kRows + "0\n3 0 1 2\n2 0 1 255 0 0\n", small_faces(2)},
        {"ply_NameTwice",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty int flags\nproperty int flags\n"
         "property int x\nproperty int y\nproperty int z\nelement face 1\n"
         "property list uchar int vertex_index\nend_header\n"
         "1 2 0 0 0\n1 2 1 0 0\n1 2 0 1 0\n3 0 1 2\n",
         {"1 property of a name that an earlier one has: passed over"}},
        {"off_Glued",
         "OFF3 1 0\n" + kRows + "3 0 1 2\n",
         {"1 space missing between OFF and the counts"}},
        {"off_LowerCase", "off\n3 1 0\n" + kRows + "3 0 1 2\n", {}},
        {"stl_EndSolid", "solid a\n" + facet() + "end solid a\n", two_words},
        {"stl_EndSolidAtTheEnd", "solid a\n" + facet() + "End Solid", two_words},
        {"stl_EndLoop", "solid\n" + facet("end loop") + "endsolid\n", two_words},
        {"stl_EndFacet", "solid\n" + facet("endloop", "END FACET") + "endsolid\n", two_words},
        {"stl_LinesBeforeSolid",
         "\n# a tool\n\nversion 2\nsolid\n" + facet() + "endsolid\n",
         {"2 lines of comment or outside of solids passed over"}},
        {"stl_LongCommentBeforeSolid",
         std::string(5000, ';') + "\nsolid\n" + facet() + "endsolid",
         {"1 line of comment or outside of solids passed over"}},
        {"stl_LinesBehind",
         "solid\nendsolid\n; next\nsolid\n" + facet() + "endsolid\nthe end\n\x1A",
         {"3 lines of comment or outside of solids passed over"}},
        {"stl_Comment",
         "solid\n# the only one\n" + facet() + "endsolid\n",
         {"1 line of comment or outside of solids passed over"}},
        {"stl_ControlCharacters", "solid \x01\x1B\x7F\n" + facet() + "endsolid\n", {}},
        {"stl_SmallFacets",
         "solid\n" + facet() +
             "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n"
             "facet\nouter loop\nendloop\nendfacet\nendsolid\n",
         small_faces(2)},
        {"stl_BinaryWithMore",
         binary_stl("solid x", "tail"),
         {"4 bytes behind the last facet passed over"}},
        {"stl_BinaryPadded",
         binary_stl("\xFF\xFE", std::string(50, '\0')),
         {"50 bytes behind the last facet passed over"}},
    };
    for (const std::string nan :
         {"nan", "-nan(ind)", "1.#QNAN", "-1.#IND00", "Infinity", "1e999"}) {
        const std::string row = "5 " + nan + " 5\n";
        const std::string number = std::to_string(all.size());
        all.push_back({"obj_Unused" + number, kObj + "v " + row + "f 1 2 3\n", placed});
        all.push_back({"ply_Unused" + number, ply(4, 1, kRows + row + "3 0 1 2\n"), placed});
        all.push_back({"off_Unused" + number, "OFF\n4 1 0\n" + kRows + row + "3 0 1 2\n", placed});
    }
    return all;
}

class LenientReader : public testing::TestWithParam<Trifle> {};

TEST_P(LenientReader, TakesATrifleAndCountsIt)
{
    const Trifle& trifle = GetParam();
    const TemporaryFolder folder;
    const Scene scene =
        read_scene(folder.file(trifle.name + '.' + trifle.name.substr(0, 3), trifle.contents));
    EXPECT_EQ(scene.notes, trifle.notes);
    EXPECT_EQ(scene.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
    EXPECT_EQ(scene.positions[1], glm::dvec3(1, 0, 0));
    // whatever was odd, every format can be written and read again
    const std::vector<Occlusion> occlusion(scene.positions.size());
    for (const char* name : {"out.obj", "out.ply", "out.off"}) {
        write_scene(folder / name, scene, occlusion);
        const Scene again = read_scene(folder / name);
        EXPECT_EQ(again.triangles, scene.triangles) << name;
        EXPECT_EQ(again.positions, scene.positions) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(All, LenientReader, testing::ValuesIn(trifles()),
                         [](const auto& test) { return test.param.name; });

// ---- vertices without a place
// --------------------------------------------------------------------

/// One triangle of size 1, a million from the origin, and a first vertex that it does not use.
const std::vector<std::pair<std::string, std::string>> kFarTriangles{
    {"far.obj", "v nan 0 0\nv 1000000 0 0\nv 1000001 0 0\nv 1000000 1 0\nf 2 3 4\n"},
    {"far.ply", ply(4, 1, "0 inf 0\n1000000 0 0\n1000001 0 0\n1000000 1 0\n3 1 2 3\n")},
    {"far.off", "OFF\n4 1 0\n0 0 -nan\n1000000 0 0\n1000001 0 0\n1000000 1 0\n3 1 2 3\n"},
    {"far.glb",
     [] {
         GltfMaker maker = test::square();
         maker.bin.replace(0, 48,
                           bytes_of<float>({0, kNaN, 0, 1e6, 0, 0, 1000001, 0, 0, 1e6, 1, 0}));
         maker.bin.replace(48, 12, bytes_of<std::uint16_t>({1, 2, 3, 1, 2, 3}));
         return maker.glb();
     }()},
};

TEST(VertexWithoutPlace, StandsAtAUsedOneAndMovesNothing)
{
    const TemporaryFolder folder;
    for (const auto& [name, contents] : kFarTriangles) {
        const Scene scene = read_scene(folder.file(name, contents));
        ASSERT_EQ(scene.positions.size(), 4u) << name;
        EXPECT_EQ(scene.positions[0], glm::dvec3(1e6, 0, 0)) << name;
        EXPECT_EQ(make_geometry(scene).frame.centre, glm::dvec3(1e6 + 0.5, 0.5, 0)) << name;
        EXPECT_EQ(scene.notes.size(), 1u) << name;

        const std::vector<Occlusion> occlusion(4);
        for (const std::string& out : {std::string("out.obj"), std::string("out.ply"), name}) {
            const std::filesystem::path path = folder / ("new_" + out);
            write_scene(path, scene, occlusion);
            EXPECT_EQ(read_scene(path).positions, scene.positions) << name << " as " << out;
        }
    }
}

TEST(VertexWithoutPlace, StaysInTheFilesOwnWordsAsItWas)
{
    const TemporaryFolder folder;
    for (const std::string name : {"own.obj", "own.ply"}) {
        const bool is_obj = name == "own.obj";
        const Scene scene =
            read_scene(folder.file(name, is_obj ? kObj + "v 1 -nan(ind) 2\nf 1 2 3\n"
                                                : ply(4, 1, kRows + "1 -nan(ind) 2\n3 0 1 2\n")));
        write_scene(folder / ("new_" + name), scene, std::vector<Occlusion>(4));
        EXPECT_NE(contents_of(folder / ("new_" + name)).find("1 -nan(ind) 2 "), std::string::npos)
            << name;
    }
}

// ---- glTF
// ----------------------------------------------------------------------------------------

std::string chunk(const std::string& type, const std::string& contents, std::size_t size)
{
    return bytes_of({static_cast<std::uint32_t>(size)}) + type + contents;
}

/// A GLB of chunks as they are; the header has this length, or the right one.
std::string container(const std::string& chunks, std::uint32_t length = 0)
{
    const auto right = static_cast<std::uint32_t>(12 + chunks.size());
    return "glTF" + bytes_of<std::uint32_t>({2, length == 0 ? right : length}) + chunks;
}

const std::string kBin("BIN\0", 4);

/// The document as a text that lacks three bytes to a multiple of four.
std::string odd_text(const GltfMaker& maker)
{
    std::string text = maker.document.dump();
    text.insert(1, (5 - text.size() % 4) % 4, ' ');
    return text;
}

std::string chunks(const std::string& text, const std::string& bin)
{
    return chunk("JSON", text, text.size()) + chunk(kBin, bin, bin.size());
}

/// The bytes as %00.
std::string percent_encoded(const std::string& bytes)
{
    std::string text;
    for (const unsigned char c : bytes) {
        text += '%';
        text += "0123456789abcdef"[c / 16];
        text += "0123456789abcdef"[c % 16];
    }
    return text;
}

/// All of them show the square.
struct GltfTrifle {
    const char* name;
    const char* note;  ///< part of the only one; empty: there is none
    std::string (*make)(GltfMaker square);
};

void PrintTo(const GltfTrifle& trifle, std::ostream* stream)
{
    *stream << trifle.name;
}

/// The square after `change`.
template <typename Change>
std::string changed(GltfMaker& maker, const Change& change)
{
    change(maker.document);
    return maker.glb();
}

// long: a table
const GltfTrifle kGltfTrifles[] = {
    {"JsonNotPadded", "1 chunk of the GLB of a length that is no multiple of 4",
     [](GltfMaker m) { return container(chunks(odd_text(m), m.bin)); }},
    {"PaddingNotCounted", "1 chunk of the GLB of a length that is no multiple of 4",
     [](GltfMaker m) {
         const std::string text = odd_text(m);
         return container(chunk("JSON", text + "   ", text.size()) +
                          chunk(kBin, m.bin, m.bin.size()));
     }},
    {"NoChunkPadded", "2 chunks of the GLB of a length that is no multiple of 4",
     [](GltfMaker m) { return container(chunks(odd_text(m), m.bin + "xy")); }},
    {"PaddedWithZeros", "3 zero bytes behind the JSON passed over",
     [](GltfMaker m) { return container(chunks(odd_text(m) + std::string(3, '\0'), m.bin)); }},
    {"ByteOrderMark", "",
     [](GltfMaker m) { return container(chunks("\xEF\xBB\xBF" + odd_text(m), m.bin)); }},
    {"LengthTooLarge", "the GLB's header says 4294967295 bytes, the file has ",
     [](GltfMaker m) { return container(chunks(odd_text(m) + "   ", m.bin), 0xFFFFFFFFu); }},
    {"LengthTooSmall", "the GLB's header says 40 bytes, the file has ",
     [](GltfMaker m) { return container(chunks(odd_text(m) + "   ", m.bin), 40); }},
    {"LengthBelowHeader", "the GLB's header says 1 byte, the file has ",
     [](GltfMaker m) { return container(chunks(odd_text(m) + "   ", m.bin), 1); }},
    {"BytesBehind", "9 bytes behind the end of the GLB passed over",
     [](GltfMaker m) { return m.glb() + "ninebytes"; }},
    {"VersionIsNumber", "",
     [](GltfMaker m) { return changed(m, [](json& d) { d["asset"]["version"] = 2.0; }); }},
    {"StrideZero", "2 bufferViews with byteStride 0: taken as close together",
     [](GltfMaker m) {
         return changed(m, [](json& d) {
             for (json& view : d["bufferViews"])
                 view["byteStride"] = 0;
         });
     }},
    {"StrideOfIndices", "1 bufferView with a byteStride that is no multiple of 4 up to 252",
     [](GltfMaker m) {
         return changed(m, [](json& d) { d["bufferViews"][1]["byteStride"] = 2; });
     }},
    {"StrideOfElements", "",
     [](GltfMaker m) {
         return changed(m, [](json& d) { d["bufferViews"][0]["byteStride"] = 12; });
     }},
    {"StrideBeyondLimit", "1 bufferView with a byteStride that is no multiple of 4 up to 252",
     [](GltfMaker m) {
         const std::string points = m.bin.substr(0, 48);
         std::string spread(4 * 256, '\0');
         for (std::size_t v = 0; v < 4; ++v)
             spread.replace(v * 256, 12, points, v * 12, 12);
         const int view = m.add_view(spread, 256);
         return changed(m, [&](json& d) { d["accessors"][0]["bufferView"] = view; });
     }},
    {"ViewEndsInPadding", "1 bufferView longer than its buffer, by what nothing uses",
     [](GltfMaker m) {
         return changed(m, [](json& d) { d["bufferViews"][1]["byteLength"] = 15; });
     }},
    {"BufferLacksPadding", "buffer 0 lacks its last bytes, which nothing uses",
     [](GltfMaker m) { return changed(m, [](json& d) { d["buffers"][0]["byteLength"] = 63; }); }},
    {"FloatNormalized", "1 accessor both float and normalized: taken as float",
     [](GltfMaker m) {
         return changed(m, [](json& d) { d["accessors"][0]["normalized"] = true; });
     }},
    {"IndicesNormalized", "",
     [](GltfMaker m) {
         return changed(m, [](json& d) { d["accessors"][1]["normalized"] = true; });
     }},
    {"WrongBounds", "",
     [](GltfMaker m) {
         return changed(m, [](json& d) { d["accessors"][0]["min"] = {9, "nine", nullptr}; });
     }},
    {"NothingInArrays", "",
     [](GltfMaker m) {
         return changed(m, [](json& d) {
             for (const char* key : {"animations", "materials", "extensionsRequired", "skins"})
                 d[key] = json::array();
         });
     }},
    {"UnusedExtensionBroken", "",
     [](GltfMaker m) {
         return changed(m, [](json& d) {
             d["extensionsUsed"] = {"ACME_secret", "KHR_texture_transform"};
             d["extensionsRequired"] = {"KHR_texture_transform"};
             d["extensions"] = {{"ACME_secret", 7}, {"KHR_lights_punctual", "none"}};
         });
     }},
    {"PrimitiveWithoutPosition", "2 primitives without POSITION are left out",
     [](GltfMaker m) {
         return changed(m, [](json& d) {
             json& primitives = d["meshes"][0]["primitives"];
             primitives.push_back({{"attributes", json::object()}});
             primitives.push_back(json::object());
         });
     }},
    {"PrimitiveWithoutCorners", "1 primitive of fewer than three corners is left out",
     [](GltfMaker m) {
         return changed(m, [](json& d) {
             d["accessors"].push_back(
                 {{"bufferView", 1}, {"componentType", 5123}, {"type", "SCALAR"}, {"count", 0}});
             d["meshes"][0]["primitives"].push_back(
                 {{"attributes", {{"POSITION", 0}}}, {"indices", 2}});
         });
     }},
    {"CornersLeftOver", "1 corner behind the last whole triangle is left out",
     [](GltfMaker m) {
         const int indices = m.add_indices<std::uint8_t>({0, 1, 2, 0, 2, 3, 1});
         return changed(m, [&](json&) { test::primitive(m)["indices"] = indices; });
     }},
    {"NanInNormals", "",
     [](GltfMaker m) {
         const int normals =
             m.add_vectors<float>({kNaN, 0, 0, 0, kNaN, 0, 0, 0, 1, kNaN, kNaN, kNaN});
         test::primitive(m)["attributes"]["NORMAL"] = normals;
         test::primitive(m)["attributes"]["TEXCOORD_0"] = m.add_accessor(
             m.add_view(test::bytes_of<float>({kNaN, 0, 0, kNaN, 0, 0, 1, 1})), 5126, "VEC2", 4);
         return m.glb();
     }},
    {"DataUriAsItIs", "",
     [](GltfMaker m) { return m.gltf("data:text/plain," + percent_encoded(m.bin)); }},
    {"DataUriOfAnyKind", "",
     [](GltfMaker m) { return m.gltf(make_data_uri("model/odd;charset=none", m.bin)); }},
    {"DataUriWithBlanks", "",
     [](GltfMaker m) {
         std::string uri = make_data_uri("", m.bin);
         uri.replace(uri.find("base64"), 6, "BASE64");
         return m.gltf(uri.insert(40, "\r\n ") + '\n');
     }},
};

class LenientGltfReader : public testing::TestWithParam<GltfTrifle> {};

TEST_P(LenientGltfReader, TakesATrifleAndCountsIt)
{
    const GltfTrifle& trifle = GetParam();
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("in.gltf", trifle.make(test::square())));
    const Notes wanted(trifle.note[0] == '\0' ? 0 : 1, trifle.note);
    ASSERT_EQ(scene.notes.size(), wanted.size()) << testing::PrintToString(scene.notes);
    for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_TRUE(scene.notes[i].starts_with(wanted[i])) << scene.notes[i];
    EXPECT_EQ(scene.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(scene.positions,
              (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    const std::vector<Occlusion> occlusion(4);
    for (const char* name : {"out.glb", "out.gltf", "out.ply"}) {
        write_scene(folder / name, scene, occlusion);
        EXPECT_EQ(read_scene(folder / name).positions, scene.positions) << name;
        EXPECT_EQ(read_scene(folder / name).triangles, scene.triangles) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(Each, LenientGltfReader, testing::ValuesIn(kGltfTrifles),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(GltfUri, FindsFilesWhoseNamesAreNotEncoded)
{
    const TemporaryFolder folder;
    const GltfMaker maker = test::square();
    std::filesystem::create_directory(folder / "a b");
    for (const std::string name : {"a b/100%.bin", "%zz", "c#d.bin"}) {
        folder.file(name, maker.bin);
        EXPECT_EQ(read_scene(folder.file("in.gltf", maker.gltf(name))).triangles.size(), 2u)
            << name;
    }
    EXPECT_EQ(read_scene(folder.file("in.gltf", maker.gltf("a%20b/100%25.bin"))).triangles.size(),
              2u);
}

}  // namespace
}  // namespace surfelao
