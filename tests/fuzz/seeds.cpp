// Small good files for the fuzzers to start from: fuzz_seeds FOLDER fills FOLDER/<fuzzer>.
#include "files/cloud_cases.h"
#include "files/gltf_maker.h"
#include "surfels/extension.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace surfelao::test;

/// A sparse square out of the plain one: vertex 2 moves.
GltfMaker sparse_square()
{
    GltfMaker maker = square();
    const int indices = maker.add_view(bytes_of<std::uint8_t>({2}));
    const int values = maker.add_view(bytes_of<float>({2, 2, 1}));
    maker.document["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
        {"values", {{"bufferView", values}}}};
    return maker;
}

/// Two nodes with one mesh of two primitives: a strip with colours, and a fan of quantised points.
GltfMaker everything()
{
    GltfMaker maker = square();
    const int colors = maker.add_vectors<std::uint8_t>({9, 9, 9, 8, 8, 8, 7, 7, 7, 6, 6, 6});
    const int points = maker.add_accessor(
        maker.add_view(bytes_of<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0}), 4), 5120,
        "VEC3", 3);
    maker.document["accessors"][colors]["normalized"] = true;
    maker.document["accessors"][points]["normalized"] = true;
    maker.document["meshes"][0]["primitives"] = {
        {{"attributes", {{"POSITION", 0}, {"COLOR_0", colors}}}, {"mode", 5}},
        {{"attributes", {{"POSITION", points}}}, {"mode", 6}}};
    maker.document["nodes"] = {
        {{"name", "a"}, {"mesh", 0}, {"children", {1}}, {"scale", {-1, 2, 1}}},
        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1}}}};
    maker.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    return maker;
}

/// A skinned and morphed square with normals, and two instances of it, one node hidden.
GltfMaker posed()
{
    GltfMaker maker = square();
    const int vectors = maker.add_vectors<float>({0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 1});
    const int joints = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0})),
        5121, "VEC4", 4);
    const int weights = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>({9, 9, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 9, 0, 0, 0})),
        5121, "VEC4", 4);
    maker.document["accessors"][weights]["normalized"] = true;
    const int binds = maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1,
                                        0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})),
        5126, "MAT4", 2);
    const int places = maker.add_vectors<float>({0, 0, 0, 0, 0, 5});
    const int turns = maker.add_accessor(
        maker.add_view(bytes_of<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170})), 5122, "VEC4",
        2);
    maker.document["accessors"][turns]["normalized"] = true;
    maker.document["meshes"][0]["weights"] = {0.5};
    primitive(maker)["targets"] = {{{"POSITION", vectors}, {"NORMAL", vectors}}};
    primitive(maker)["attributes"].update(
        {{"NORMAL", vectors}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    maker.document["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", binds}}};
    maker.document["nodes"] = {
        {{"mesh", 0}, {"skin", 0}, {"weights", {1}}},
        {{"rotation", {0, 0, 1, 1}}, {"children", {2}}},
        {{"scale", {1, -2, 1}}},
        {{"mesh", 0},
         {"extensions",
          {{"EXT_mesh_gpu_instancing",
            {{"attributes", {{"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", places}}}}}}}},
        {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1, 3, 4};
    maker.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing", "KHR_node_visibility"};
    return maker;
}

/// A square whose first chunk is not padded, with strides of zero and two, a vertex that is not
/// finite, and more bytes than the header says.
std::string lapses()
{
    GltfMaker maker = square();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    maker.document["accessors"][0] = {
        {"bufferView",
         maker.add_view(bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, nan, 0, 0}))},
        {"componentType", 5126},
        {"type", "VEC3"},
        {"count", 5},
        {"normalized", true}};
    maker.document["bufferViews"][1]["byteStride"] = 2;
    maker.document["bufferViews"][2]["byteStride"] = 0;
    std::string text = maker.document.dump();
    text += std::string((5 - text.size() % 4) % 4, '\0');
    const auto number = [](std::size_t n) { return bytes_of({static_cast<std::uint32_t>(n)}); };
    return "glTF" + number(2) + number(40) + number(text.size()) + "JSON" + text +
           number(maker.bin.size()) + std::string("BIN\0", 4) + maker.bin + "behind";
}

/// Two squares of one mesh: one slides, turns in a cubic spline and jumps in size.
std::string moving()
{
    GltfMaker maker = square();
    maker.add("nodes", {{"mesh", 0}});
    maker.document["scenes"][0]["nodes"] = {0, 1};
    const auto times =
        maker.add_accessor(maker.add_view(bytes_of<float>({0, 1})), 5126, "SCALAR", 2);
    const int places = maker.add_vectors<float>({0, 0, 4, 0, 0, 0.25f});
    const int turns =
        maker.add_accessor(maker.add_view(bytes_of<float>({0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0,
                                                           0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0})),
                           5126, "VEC4", 6);
    const auto channel = [](int sampler, const char* path) {
        return nlohmann::json{{"sampler", sampler}, {"target", {{"node", 1}, {"path", path}}}};
    };
    maker.document["animations"] = {
        {{"name", "fall"},
         {"samplers",
          {{{"input", times}, {"output", places}},
           {{"input", times}, {"output", turns}, {"interpolation", "CUBICSPLINE"}},
           {{"input", times}, {"output", places}, {"interpolation", "STEP"}}}},
         {"channels", {channel(0, "translation"), channel(1, "rotation"), channel(2, "scale")}}}};
    return maker.glb();
}

void save(const fs::path& path, const std::string& bytes)
{
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
}

void save_gltf_seeds(const fs::path& folder)
{
    save(folder / "triangle.glb", one_triangle().glb());
    save(folder / "square.glb", square().glb());
    save(folder / "sparse.glb", sparse_square().glb());
    save(folder / "everything.glb", everything().glb());
    save(folder / "posed.glb", posed().glb());
    save(folder / "moving.glb", moving());
    save(folder / "triangle.gltf", one_triangle().gltf(kTriangleUri));
    save(folder / "lapses.glb", lapses());
    save(folder / "as_it_is.gltf", one_triangle().gltf("data:text/plain," + std::string(36, 'A')));
}

void save_text_seeds(const fs::path& folder)
{
    save(folder / "obj/square.obj",
         "# square\nmtllib a.mtl\no one\nv 0 0 0\nv 1 0 0\nv 1 1 0 1\nv 0 1 0 .5 .5 .5\n"
         "vt 0 0\nvn 0 0 1\ng a b\ns 1\nusemtl m\nf 1/1/1 2//1 3/1 4\nl 1 2\np 1\n");
    save(folder / "obj/concave.obj",
         "v -0 0 0\r\nv 4e0 0 0\r\nv 4 4. 0\r\nv 2 \\\r\n+1 0\r\nv .0 4 0 1 2 3 4\r\n"
         "f -5 -4 -3 \\\r\n -2 -1\r\n");
    save(folder / "obj/normals.obj",
         "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nvn 0 0 1\nvn nan 0 1e39\n"
         "f 1//-1 2//1 3//2 4 5/1/-2\nvn 1 0 0\nf 1//1 2//2 3//3\n");
    save(
        folder / "obj/lapses.obj",
        "v 0 0 0\nv nan 0 1.#QNAN\nv 1 0 0 nan 1.#IND nan\nv 0 1 0\nf 1 2\nf\nf 1//9 3//0 4//-7\n");
    save(folder / "off/lapses.off", "OFF4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -inf 0\n0\n3 0 1 2\n2 0 1\n");
    save(folder / "off/square.off",
         "OFF # square\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3 255 0 0\n");
    save(folder / "off/colours.off",
         "STCNOFF 3 2 3\n\n0 0 0 0 0 1 9 9 9 255 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n");
    save(folder / "stl/two.stl",
         "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
         "endloop\nendfacet\nendsolid a\nSOLID b\nFACET NORMAL 0 0 1\n OUTER LOOP\n"
         " VERTEX 0 0 0\n VERTEX 1 0 0\n VERTEX 1 1 0\n ENDLOOP\nENDFACET\nENDSOLID b\n");
    save(folder / "stl/lapses.stl",
         "# c\nby hand\nsolid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
         "end loop\nend facet\n# c\nfacet\nouter loop\nvertex 0 0 0\nendloop\nendfacet\n"
         "end solid\nthe end\n");
    save(folder / "stl/binary.stl",
         std::string(80, ' ') + bytes_of<std::uint32_t>({2}) +
             bytes_of<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + "ab" +
             bytes_of<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}) + "ab");
}

/// A square of one quad, in every format, with other properties and elements around it.
void save_ply_seeds(const fs::path& folder)
{
    const std::string header =
        "comment square\nobj_info none\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nelement face 1\nproperty uchar flags\n"
        "property list uchar int vertex_indices\n";
    const std::string rows = "0 0 0 7\n1 0 0 7\n1 1 0 7\n0 1 0 7\n9 4 0 1 2 3\n";
    save(folder / "ascii.ply", "ply\nformat ascii 1.0\n" + header + "end_header\n" + rows);
    save(folder / "crlf.ply",
         "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty int x\r\nproperty short y\r\n"
         "property double z\r\nelement tristrips 1\r\nproperty list int int vertex_indices\r\n"
         "end_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n4 0 1 2 -1\r\n");

    const auto vertex = [](float x, float y) { return bytes_of<float>({x, y, 0}) + "\x07"; };
    save(folder / "little.ply", "ply\nformat binary_little_endian 1.0\n" + header + "end_header\n" +
                                    vertex(0, 0) + vertex(1, 0) + vertex(1, 1) + vertex(0, 1) +
                                    "\x09\x04" + bytes_of<std::int32_t>({0, 1, 2, 3}));
    const std::string with_normals =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty int8 nz\nelement face 1\n"
        "property list uchar uchar vertex_indices\nend_header\n";
    save(folder / "normals.ply", "ply\nformat ascii 1.0\n" + with_normals +
                                     "0 0 0 0 0 1\n1 0 0 nan 0 1\n0 1 0 0 1e39 -1\n3 0 1 2\n");
    save(folder / "little_normals.ply",
         "ply\nformat binary_little_endian 1.0\n" + with_normals +
             bytes_of<float>({0, 0, 0, 0, 0}) + "\x7F" + bytes_of<float>({1, 0, 0, 0, 1}) + "\x81" +
             bytes_of<float>({0, 1, 0, 1, 0}) + "\x01" + std::string("\3\0\1\2", 4));
    const std::string big_header =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty list uchar ushort tags\n"
        "property int8 x\nproperty uint8 y\nproperty int16 z\nproperty float occlusion\n"
        "element face 1\nproperty list uint32 uint16 vertex_index\nend_header\n";
    const std::string big_rows("\0\0\0\0\0....\1ab\1\0\0\0....\0\0\1\0\0....\0\0\0\3\0\0\0\1\0\2",
                               9 + 11 + 9 + 10);
    save(folder / "big.ply", big_header + big_rows);
    save(folder / "lapses.ply",
         "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 nan\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 1 2 3\n0\n");
}

/// The clouds of the tests of the readers: each kind of file, and what stands in it.
void save_cloud_seeds(const fs::path& folder)
{
    for (const surfelao::test::CloudCase& cloud : surfelao::test::clouds()) {
        const std::string extension = surfelao::lower_extension(cloud.name);
        const bool is_text = extension != ".ply" && extension != ".pcd" && extension != ".obj" &&
                             extension != ".off";
        save(folder / (is_text ? "xyz" : extension.substr(1)) / cloud.name, cloud.contents);
    }
    save(folder / "xyz/result.txt",
         "X,Y,Z,R,G,B,occlusion,bent_nx,bent_ny,bent_nz,own_red,own_green,own_blue\n"
         "1,2,3,9,9,9,0.5,0,0,1,7,8,9\n# surfelao 0 bake: colors=grey\n");
}

/// Scenes of every engine, as solve_fuzz.cpp reads them: bytes that look like nothing in
/// particular, and grids of places with the triangles between neighbours.
void save_solve_seeds(const fs::path& folder)
{
    for (int engine = 0; engine < 4; ++engine) {
        std::string head(12, '\0');
        head[0] = static_cast<char>(engine);
        head[1] = '\x40';
        std::string scattered = head, grid = head;
        std::uint32_t state = 1;
        for (int i = 0; i < 600; ++i) {
            state = 1664525u * state + 1013904223u;  // Numerical Recipes' generator
            scattered += static_cast<char>(state >> 24);
        }
        grid += "\x3D\x62";  // 64 vertices; 99 triangles
        grid += '\0';
        for (int v = 0; v < 64; ++v)
            grid += {static_cast<char>(12 + v % 8), static_cast<char>(12 + v / 8),
                     static_cast<char>(16 + v * v % 5)};
        for (int t = 0; t < 49; ++t) {
            const int a = t / 7 * 8 + t % 7;
            grid += {static_cast<char>(a), static_cast<char>(a + 1), static_cast<char>(a + 9),
                     static_cast<char>(a), static_cast<char>(a + 9), static_cast<char>(a + 8)};
        }
        save(folder / ("scattered" + std::to_string(engine)), scattered);
        save(folder / ("grid" + std::to_string(engine)), grid);
    }
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
        return 2;
    const fs::path folder = argv[1];
    save_gltf_seeds(folder / "gltf");
    save_ply_seeds(folder / "ply");
    save_text_seeds(folder);
    save_cloud_seeds(folder);
    save_solve_seeds(folder / "solve");
}
