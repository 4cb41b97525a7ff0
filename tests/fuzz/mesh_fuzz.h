/// mesh_fuzz.h: a reader of meshes or clouds, all but glTF, on any bytes: refuses them in one
/// sentence, or gives a scene that keeps its promises and survives being written in every format
/// and read again.
#pragma once

#include "scene_checks.h"

#include "files/maker_mark.h"
#include "files/obj_io.h"
#include "files/off_io.h"
#include "files/pcd_io.h"
#include "files/ply_io.h"
#include "files/xyz_io.h"
#include "surfels/content_hash.h"

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// Positions and triangles are the same; PLY may round coordinates to float, and then polygons may
/// be cut differently.
inline void check_same(const Scene& again, const Scene& scene, bool rounded)
{
    SURFELAO_CHECK(again.positions.size() == scene.positions.size());
    SURFELAO_CHECK(again.triangles.size() == scene.triangles.size());
    SURFELAO_CHECK(rounded || again.positions == scene.positions);
    SURFELAO_CHECK(rounded || again.triangles == scene.triangles);
}

/// Value by value, nan included.
inline void check_same_normals(const CornerNormals& again, const CornerNormals& normals)
{
    SURFELAO_CHECK(again.corners == normals.corners);
    SURFELAO_CHECK(again.values.size() == normals.values.size());
    SURFELAO_CHECK(normals.empty() || std::memcmp(again.values.data(), normals.values.data(),
                                                  sizeof(glm::vec3) * normals.values.size()) == 0);
}

/// What was baked with shaded colours and is baked again with the file's own is as if baked once.
template <class Read, class Write>
void check_baked_twice(const Scene& scene, std::span<const Occlusion> occlusion, const Read& read,
                       const Write& write)
{
    const auto options_of = [](VertexColors colors) {
        return WriteOptions{colors, Encoding::automatic,
                            make_mark("bake", "colors=" + name_of(colors))};
    };
    const WriteOptions keep = options_of(VertexColors::keep);
    const Scene shaded =
        read("baked", write(scene, occlusion, options_of(VertexColors::shaded)).contents);
    SURFELAO_CHECK(write(shaded, occlusion, keep).contents ==
                   write(scene, occlusion, keep).contents);
}

enum class From { obj, ply, pcd, xyz, other };

/// Over places for each corner that come apart in some faces.
inline void check_maps(const Scene& scene)
{
    OcclusionMap map{"", 0, UvSet{}};
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        map.uvs->corners.push_back(t % 5 == 4 ? glm::uvec3(UvSet::kNone)
                                              : glm::uvec3(0, 1, t % 3 == 2 ? 2 : 1));
    }
    map.uvs->values = {{0.0, 0.0}, {0.25, 0.5}, {0.5, 1.0}};
    const Scene obj = read_obj("obj", obj_contents_with_map("x.obj", scene, map).contents);
    SURFELAO_CHECK(obj.triangles == scene.triangles);
    for (const glm::uvec3& triangle : obj.triangles) {  // vertices without a place move on
        for (int k = 0; k < 3; ++k)
            SURFELAO_CHECK(obj.positions[triangle[k]] == scene.positions[triangle[k]]);
    }
    const Scene ply = read_ply("ply", ply_contents_with_map("x.ply", scene, map).contents);
    SURFELAO_CHECK(ply.triangles.size() == scene.triangles.size());
    SURFELAO_CHECK(obj.uvs.size() == ply.uvs.size());
}

/// What came from OBJ or PLY keeps its normals there.
inline void check_round_trips(const Scene& scene, From from)
{
    std::vector<Occlusion> occlusion(scene.positions.size());
    for (std::size_t v = 0; v < occlusion.size(); ++v)
        occlusion[v] = {static_cast<float>(v % 8) / 7.0f, {0.0f, 0.0f, 1.0f}};
    const Scene from_obj = read_obj("obj", obj_contents("x.obj", scene, occlusion).contents);
    check_same(from_obj, scene, false);
    if (from == From::obj)
        check_same_normals(from_obj.normals, scene.normals);
    check_same(read_off("off", off_contents(scene, occlusion).contents), scene, false);
    const std::string ply = ply_contents("x.ply", scene, occlusion).contents;
    const Scene again = read_ply("ply", ply);
    check_same(again, scene, from != From::ply);
    if (from == From::ply)
        check_same_normals(again.normals, scene.normals);
    // what we wrote is replaced, not added to
    SURFELAO_CHECK(ply_contents("x.ply", again, occlusion).contents.size() == ply.size());
    check_maps(scene);
    check_baked_twice(scene, occlusion, read_off, off_contents);
    check_baked_twice(scene, occlusion, read_obj,
                      [](auto&&... rest) { return obj_contents("x.obj", rest...); });
    check_baked_twice(scene, occlusion, read_ply,
                      [](auto&&... rest) { return ply_contents("x.ply", rest...); });
}

/// A result in one format: as many points, at the same places (to floats where `rounded`).
template <class Read, class Write>
void check_cloud(const Scene& scene, std::span<const Occlusion> occlusion, bool rounded,
                 const Read& read, const Write& write)
{
    const Scene again = read("again", write(scene, occlusion, WriteOptions()).contents);
    SURFELAO_CHECK(again.triangles.empty());
    SURFELAO_CHECK(again.positions.size() == scene.positions.size());
    SURFELAO_CHECK(rounded || again.positions == scene.positions);
    SURFELAO_CHECK(rounded || again.viewpoint == scene.viewpoint || !again.viewpoint);
    check_baked_twice(scene, occlusion, read, write);
}

/// Every format takes it; text leaves out the points that are nowhere. Each cloud goes through one
/// of them, which its bytes choose: through all, an execution costs five times as much.
inline void check_clouds(const Scene& scene, From from, std::string_view contents)
{
    std::vector<Occlusion> occlusion(scene.positions.size());
    for (std::size_t v = 0; v < occlusion.size(); ++v)
        occlusion[v] = {static_cast<float>(v % 8) / 7.0f, {0.0f, 0.0f, 1.0f}};
    ContentHash hash;
    hash.add(std::span<const char>(contents));
    const std::uint64_t choice = hash.low() % (scene.placeless.empty() ? 6 : 4);
    if (choice == 0)
        check_cloud(scene, occlusion, from != From::pcd, read_pcd, pcd_contents);
    if (choice == 1)
        check_cloud(scene, occlusion, from != From::ply, read_ply,
                    [](auto&&... rest) { return ply_contents("x.ply", rest...); });
    if (choice == 2)
        check_cloud(scene, occlusion, false, read_off, off_contents);
    if (choice == 3)
        check_cloud(scene, occlusion, false, read_obj,
                    [](auto&&... rest) { return obj_contents("x.obj", rest...); });
    if (choice >= 4) {
        const char* name = choice == 4 ? "x.xyz" : "x.pts";
        check_cloud(
            scene, occlusion, false,
            [](const char* again, const std::string& text) { return read_xyz(again, text); },
            [name](auto&&... rest) { return xyz_contents(name, rest...); });
    }
}

template <class Read>
int fuzz_mesh(From from, const Read& read, const std::uint8_t* data, std::size_t size)
{
    const std::string contents(reinterpret_cast<const char*>(data), size);
    try {
        const Scene scene = read("fuzzed", contents);
        check_invariants(scene);
        if (scene.positions.size() > 10'000)
            return 0;
        if (scene.triangles.empty()) {
            check_clouds(scene, from, contents);
            return 0;
        }
        check_geometry(scene);
        check_round_trips(scene, from);
    } catch (const InputError& error) {
        SURFELAO_CHECK(std::string_view(error.what()).starts_with("fuzzed: "));
        SURFELAO_CHECK(std::string_view(error.what()).size() < 300);
    }
    return 0;
}

}  // namespace surfelao
