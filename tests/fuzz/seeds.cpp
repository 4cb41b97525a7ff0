// Small good files for the fuzzers to start from: fuzz_seeds FOLDER fills FOLDER/<fuzzer>.
#include "surfels/gltf_maker.h"

#include <filesystem>
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

void write_gltf_seeds(const fs::path& folder)
{
    fs::create_directories(folder);
    one_triangle().save_glb(folder / "triangle.glb");
    square().save_glb(folder / "square.glb");
    sparse_square().save_glb(folder / "sparse.glb");
    everything().save_glb(folder / "everything.glb");
    GltfMaker text = one_triangle();
    text.document["buffers"][0]["uri"] =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    write_file(folder / "triangle.gltf", text.document.dump());
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
        return 2;
    write_gltf_seeds(fs::path(argv[1]) / "gltf");
}
