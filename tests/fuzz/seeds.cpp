// Small good files for the fuzzers to start from: fuzz_seeds FOLDER fills FOLDER/<fuzzer>.
#include "surfels/gltf_maker.h"

#include <filesystem>
#include <fstream>
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
    save(folder / "triangle.gltf", one_triangle().gltf(kTriangleUri));
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
        return 2;
    save_gltf_seeds(fs::path(argv[1]) / "gltf");
}
