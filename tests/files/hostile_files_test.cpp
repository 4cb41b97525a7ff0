// Files of a few megabytes made to cost time or memory: read or refused, each must be done with
// within ten seconds and with memory in proportion to the file. The table of what is wrong with
// small files is malformed_mesh_test.cpp and gltf_malformed_test.cpp.
#include "files/scene_io.h"
#include "surfels/errors.h"

#include "gltf_maker.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// Processor time, so that a busy machine is no failure. A tenth of it is normal, and ten times as
/// much where every access is checked and nothing optimised.
constexpr rlim_t kSeconds = kSanitized ? 100 : 10;

// The dearest honest files: PLY triangle strips of one byte a corner, and binary corners.
constexpr rlim_t kBaseMemory = 256u << 20;
constexpr rlim_t kMemoryPerByte = 160;

struct Hostile {
    std::string name;  ///< up to the first '_': the extension
    std::function<std::string()> make;
    std::string outcome;  ///< part of the refusal; empty: it is read
};

void PrintTo(const Hostile& hostile, std::ostream* stream)
{
    *stream << hostile.name;
}

constexpr int kMillion = 1'000'000;

std::string times(int count, const std::string& text)
{
    std::string all;
    all.reserve(text.size() * static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        all += text;
    return all;
}

std::string each(int count, const std::function<std::string(int)>& make)
{
    std::string all;
    for (int i = 0; i < count; ++i)
        all += make(i);
    return all;
}

/// Equal on every machine; Numerical Recipes' generator.
int scattered(int i)
{
    return static_cast<int>((1664525u * static_cast<std::uint32_t>(i) + 1013904223u) >> 12);
}

std::string number(int i)
{
    return std::to_string(i) + ' ';
}

// ---- makers of contents

const std::string kObjPoints = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

std::string obj(const std::string& rest)
{
    return kObjPoints + "f 1 2 3\n" + rest;
}

/// One face around all of `points` places, which are anywhere in a square.
std::string scattered_face(int points, int corners)
{
    return each(points,
                [](int i) {
                    return "v " + number(scattered(i) % 1000) + number(scattered(i + 7) % 1000) +
                           "0\n";
                }) +
           "f " + each(corners, [points](int i) { return number(scattered(i) % points + 1); }) +
           '\n';
}

const std::string kPlyVertex =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlyFace = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPlyRows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string ply(const std::string& header, const std::string& rows)
{
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + rows;
}

std::string binary_ply(const std::string& header, const std::string& rows)
{
    return "ply\nformat binary_little_endian 1.0\n" + header + "end_header\n" + rows;
}

const std::string kThreeVertices = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});

std::string off(const std::string& counts, const std::string& faces)
{
    return "OFF\n" + counts + "\n0 0 0\n1 0 0\n0 1 0\n" + faces;
}

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

/// Facets whose corners are `corner(0)`, `corner(1)`, ... on the x axis.
std::string binary_stl(int facets, const std::function<float(int)>& corner)
{
    std::string all = std::string(80, ' ') + bytes_of({static_cast<std::uint32_t>(facets)});
    for (int i = 0; i < facets; ++i) {
        all += bytes_of<float>(
            {0, 0, 1, corner(3 * i), 0, 0, corner(3 * i + 1), 0, 0, corner(3 * i + 2), 1, 0});
        all += std::string(2, '\0');
    }
    return all;
}

std::string glb(const std::function<void(GltfMaker&)>& change)
{
    GltfMaker maker = test::one_triangle();
    change(maker);
    return maker.glb();
}

/// All nodes in the scene, none below another.
void use_often(GltfMaker& maker, int count, const json& node)
{
    maker.document["nodes"] = json::array();
    maker.document["scenes"][0]["nodes"] = json::array();
    for (int i = 0; i < count; ++i)
        maker.document["scenes"][0]["nodes"].push_back(maker.add("nodes", node));
}

// ---- the table

// long: a table
std::vector<Hostile> hostile_files()
{
    const auto zero = [](int) { return 0.0f; };
    return {
        // OBJ
        {"obj_Faces", [] { return obj(times(kMillion / 2, "f 1 2 3\n")); }, ""},
        {"obj_Vertices", [] { return obj(times(kMillion / 2, "v 0 0 0\n")); }, ""},
        {"obj_LongLine", [] { return obj('#' + std::string(8 * kMillion, 'x')); }, ""},
        {"obj_OneWord", [] { return std::string(8 * kMillion, 'v'); }, "has no faces"},
        {"obj_ManyWords", [] { return times(4 * kMillion, "v "); }, "line 1: \"v\""},
        {"obj_Continued", [] { return obj(times(4 * kMillion, "\\\n")); }, ""},
        {"obj_ContinuedFace",
         [] { return kObjPoints + "f " + times(kMillion / 2, "1 \\\n2 \\\n3 \\\n") + '\n'; }, ""},
        {"obj_LongNumber", [] { return obj("v 0 0 " + std::string(8 * kMillion, '1') + '\n'); },
         ""},
        {"obj_LongFraction", [] { return obj("v 0 0 0." + std::string(8 * kMillion, '1') + '\n'); },
         ""},
        {"obj_LongExponent",
         [] { return obj("v 0 0 1e" + std::string(8 * kMillion, '0') + "1\n"); }, ""},
        {"obj_Slashes", [] { return obj("f 1 2 3" + std::string(8 * kMillion, '/') + '\n'); },
         "line 5"},
        {"obj_CarriageReturns", [] { return obj(std::string(8 * kMillion, '\r')); }, ""},
        {"obj_NulBytes", [] { return obj(std::string(8 * kMillion, '\0')); }, ""},
        {"obj_Groups", [] { return obj(times(kMillion, "g a b c\n")); }, ""},
        {"obj_FaceOfScatteredCorners", [] { return scattered_face(300'000, 300'000); }, ""},
        {"obj_FaceBetweenFewPlaces", [] { return scattered_face(20, kMillion); }, ""},
        {"obj_ManyScatteredFaces",
         [] {
             const std::string face =
                 "f " + each(1000, [](int i) { return number(i % 1000 + 1); }) + '\n';
             return scattered_face(1000, 1000) + times(1000, face);
         },
         ""},

        // PLY
        {"ply_Comments",
         [] { return ply(times(kMillion, "comment\n") + kPlyVertex + kPlyFace, kPlyRows); }, ""},
        {"ply_Elements",
         [] {
             return ply(kPlyVertex + kPlyFace +
                            each(300'000, [](int i) { return "element e" + number(i) + "0\n"; }),
                        kPlyRows);
         },
         ""},
        {"ply_Properties",
         [] {
             return ply(kPlyVertex + kPlyFace + "element e 0\n" +
                            each(300'000,
                                 [](int i) { return "property int p" + std::to_string(i) + '\n'; }),
                        kPlyRows);
         },
         ""},
        {"ply_RowsWithoutBytes",
         [] {
             return binary_ply("element dust 9000000000000000000\n" + kPlyVertex + kPlyFace,
                               kThreeVertices + '\3' + bytes_of<std::int32_t>({0, 1, 2}));
         },
         ""},
        {"ply_RowsWithoutNumbers",
         [] { return ply(kPlyVertex + kPlyFace + "element dust 9000000000000000000\n", kPlyRows); },
         ""},
        {"ply_EmptyLists",
         [] {
             return binary_ply(
                 kPlyVertex + kPlyFace + "element e 8000000\nproperty list uchar uchar a\n",
                 kThreeVertices + '\3' + bytes_of<std::int32_t>({0, 1, 2}) +
                     std::string(8 * kMillion, '\0'));
         },
         ""},
        {"ply_Faces",
         [] {
             return binary_ply(
                 kPlyVertex + "element face 2000000\nproperty list uchar uchar vertex_indices\n",
                 kThreeVertices + times(2 * kMillion, std::string("\3\0\1\2", 4)));
         },
         ""},
        {"ply_Strip",
         [] {
             return binary_ply(
                 kPlyVertex + "element tristrips 1\nproperty list int char vertex_indices\n",
                 kThreeVertices + bytes_of<std::int32_t>({6 * kMillion}) +
                     times(2 * kMillion, std::string("\0\1\2", 3)));
         },
         ""},
        {"ply_LongComment",
         [] {
             return ply(kPlyVertex + kPlyFace + "comment " + std::string(8 * kMillion, 'x') + '\n',
                        kPlyRows);
         },
         ""},
        {"ply_EndlessHeader",
         [] { return "ply\nformat ascii 1.0\n" + times(kMillion, "comment\n"); },
         "ends within the header"},

        // OFF
        {"off_Faces",
         [] { return off("3 " + number(kMillion / 2) + '0', times(kMillion / 2, "3 0 1 2\n")); },
         ""},
        {"off_Points", [] { return off("3 1000001 0", times(kMillion, "1 0\n") + "3 0 1 2\n"); },
         ""},
        {"off_Comments", [] { return times(4 * kMillion, "#\n") + off("3 1 0", "3 0 1 2\n"); }, ""},
        {"off_FaceBetweenFewPlaces",
         [] {
             return off("3 1 0", number(kMillion) + each(kMillion, [](int i) {
                                     return number(scattered(i) % 3);
                                 }) + '\n');
         },
         ""},

        // STL
        {"stl_Solids", [] { return times(kMillion / 2, "solid\nendsolid\n"); }, "has no faces"},
        {"stl_EmptyLines",
         [] { return "solid\n" + std::string(8 * kMillion, '\n') + kFacet + "endsolid\n"; }, ""},
        {"stl_LongName",
         [] { return "solid " + std::string(8 * kMillion, 'x') + '\n' + kFacet + "endsolid\n"; },
         ""},
        {"stl_OneCornerAgainAndAgain", [zero] { return binary_stl(100'000, zero); }, ""},
        {"stl_EveryCornerOnce",
         [] { return binary_stl(100'000, [](int i) { return static_cast<float>(i); }); }, ""},

        // clouds
        {"xyz_Points", [] { return times(kMillion, "0 0 0\n"); }, ""},
        {"xyz_LongLine", [] { return times(4 * kMillion, "1 "); }, "1000 columns"},
        {"xyz_LongHeader", [] { return "x y z " + times(4 * kMillion, "a ") + "\n1 2 3\n"; },
         "line 1: \"x\""},
        {"xyz_Comments", [] { return times(kMillion, "# x y z\n") + "1 2 3\n"; }, ""},
        {"xyz_Results", [] { return "1 2 3\n" + times(kMillion / 2, "# columns x y z\n"); }, ""},
        {"pcd_Fields", [] { return "FIELDS " + times(4 * kMillion, "a "); }, "1000 fields"},
        {"pcd_Array",
         [] {
             return "FIELDS x y z a\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 4000000\nPOINTS 1\n"
                    "DATA binary\n" +
                    std::string(12 + 4 * kMillion, '\0');
         },
         ""},
        {"pcd_Zeros",
         [] {
             // a point as it is, then 22 copies of it for three bytes
             const std::uint32_t copies = kMillion / 10, points = 1 + 22 * copies;
             const std::string packed =
                 '\x0B' + std::string(12, '\0') + times(copies, std::string("\xE0\xFF\0", 3));
             return "FIELDS x y z\nPOINTS " + std::to_string(points) +
                    "\nDATA binary_compressed\n" +
                    bytes_of({static_cast<std::uint32_t>(packed.size()), 12 * points}) + packed;
         },
         ""},

        // glTF
        {"glb_ChainOfNodes",
         [] {
             return glb([](GltfMaker& maker) {
                 maker.document["nodes"] = json::array();
                 for (int i = 1; i < 100'000; ++i)
                     maker.add("nodes", {{"children", {i}}});
                 maker.add("nodes", {{"mesh", 0}});
             });
         },
         ""},
        {"glb_ManyNodes",
         [] { return glb([](GltfMaker& maker) {
                  use_often(maker, 100'000, {{"mesh", 0}});
              }); },
         ""},
        {"glb_LongMeshName",
         [] {
             return glb([](GltfMaker& maker) {
                 maker.document["meshes"][0]["name"] = std::string(kMillion, 'x');
                 use_often(maker, 100'000, {{"mesh", 0}});
             });
         },
         "more repetitions than a file of this size may stand for"},
        {"glb_NodesWithoutMesh",
         [] {
             return glb([](GltfMaker& maker) {
                 for (int i = 0; i < 200'000; ++i)
                     maker.add("nodes", json::object());
             });
         },
         ""},
        {"glb_ManyPrimitives",
         [] {
             return glb([](GltfMaker& maker) {
                 json& primitives = maker.document["meshes"][0]["primitives"];
                 const json first = primitives[0];
                 for (int i = 0; i < 50'000; ++i)
                     primitives.push_back(first);
             });
         },
         ""},
        {"glb_ManyAccessors",
         [] {
             return glb([](GltfMaker& maker) {
                 const json first = maker.document["accessors"][0];
                 for (int i = 0; i < 50'000; ++i)
                     maker.add("accessors", first);
             });
         },
         ""},
        {"glb_ZerosWithoutEnd",
         [] {
             return glb([](GltfMaker& maker) {
                 maker.document["accessors"][0].erase("bufferView");
                 maker.document["accessors"][0]["count"] = 4'000'000'000u;
             });
         },
         "accessor 0"},
        {"gltf_NumbersInExtras",
         [] {
             return "{\"asset\":{\"version\":\"2.0\"},\"extras\":[" + times(2 * kMillion, "0,") +
                    "0]}";
         },
         "no node with a mesh"},
        {"gltf_LongNumber",
         [] {
             return "{\"asset\":{\"version\":\"2.0\"},\"extras\":" +
                    std::string(4 * kMillion, '1') + '}';
         },
         "number overflow"},
        {"gltf_Brackets", [] { return std::string(4 * kMillion, '['); }, "nested deeper"},
        {"gltf_DataUri",
         [] {
             return test::one_triangle().gltf("data:application/octet-stream;base64," +
                                              std::string(8 * kMillion, 'A'));
         },
         ""},
    };
}

// ---- a process of its own for each

rlim_t address_space()
{
    std::ifstream statm("/proc/self/statm");
    rlim_t pages = 0;
    statm >> pages;
    return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void limit(int resource, rlim_t most)
{
    const rlimit both{most, most};
    setrlimit(resource, &both);
}

/// What read_scene says under the limits: "" when it reads the file, else the refusal, or what
/// ended it.
std::string outcome_of(const std::filesystem::path& path)
{
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0)
        return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
        limit(RLIMIT_CORE, 0);
        limit(RLIMIT_CPU, kSeconds);
        if (!kSanitized)  // their shadow memory takes all address space
            limit(RLIMIT_AS, address_space() + kBaseMemory +
                                 kMemoryPerByte * std::filesystem::file_size(path));
        std::string said;
        try {
            static_cast<void>(read_scene(path));
        } catch (const std::exception& error) {
            said = error.what();
        }
        said.resize(std::min<std::size_t>(said.size(), 2000));
        _exit(write(ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0
                                                                                            : 1);
    }
    close(ends[1]);
    int status = 0;
    waitpid(child, &status, 0);
    std::string said(2000, '\0');
    said.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(ends[0], said.data(), 2000))));
    close(ends[0]);
    if (WIFSIGNALED(status))
        return WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL
                   ? "took more than its seconds"
                   : "died of signal " + std::to_string(WTERMSIG(status));
    return said;
}

class HostileFileSlow : public testing::TestWithParam<Hostile> {};

TEST_P(HostileFileSlow, CostsSecondsAndMemoryInProportion)
{
    const TemporaryFolder folder;
    const std::string& name = GetParam().name;
    const std::filesystem::path path =
        folder.file("hostile." + name.substr(0, name.find('_')), GetParam().make());
    const std::string said = outcome_of(path);
    EXPECT_EQ(said.empty(), GetParam().outcome.empty()) << said;
    EXPECT_NE(said.find(GetParam().outcome), std::string::npos) << said;
    EXPECT_LT(said.size(), path.string().size() + 250) << said;
}

INSTANTIATE_TEST_SUITE_P(All, HostileFileSlow, testing::ValuesIn(hostile_files()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace surfelao
