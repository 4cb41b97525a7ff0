#include "files/scene_io.h"

#include "files/file_contents.h"
#include "files/file_type.h"
#include "files/foreign_io.h"
#include "files/gltf_io.h"
#include "files/gltf_links.h"
#include "files/gltf_uri.h"
#include "files/obj_io.h"
#include "files/obj_materials.h"
#include "files/off_io.h"
#include "files/pcd_io.h"
#include "files/ply_io.h"
#include "files/stl_io.h"
#include "files/xyz_io.h"
#include "surfels/atomic_file.h"
#include "surfels/errors.h"
#include "surfels/extension.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

std::string unknown_type(const fs::path& path, const std::string& known)
{
    const std::string extension = path.extension().string();
    return (extension.empty() ? "a file without extension" : "the extension " + extension) +
           " is not known, only " + known;
}

Scene read_any(const fs::path& path, const ReadOptions& options)
{
    const std::string name = path.string();
    require(options.columns.empty() || type_of(path) == FileType::xyz,
            name + ": columns are told of .xyz .pts .txt .asc only");
    require(!options.moment || is_gltf(type_of(path)),
            name + ": only .gltf and .glb have animations");
    switch (type_of(path)) {
        case FileType::pcd:
            return read_pcd(name, read_contents(path, name));
        case FileType::xyz:
            return read_xyz(name, read_contents(path, name), options.columns);
        case FileType::obj:
            return read_obj(name, read_contents(path, name));
        case FileType::ply:
            return read_ply(name, read_contents(path, name));
        case FileType::off:
            return read_off(name, read_contents(path, name));
        case FileType::stl:
            return read_stl(name, read_contents(path, name));
        case FileType::gltf:
        case FileType::glb:
            return read_gltf(path, read_contents(path, name), options.moment, options.is_played);
        case FileType::foreign:
            return read_foreign(path, options.progress);
        default: {
            // assimp 5.2 has no reader of USD
            const bool is_usd = lower_extension(path).starts_with(".usd");
            throw InputError(
                name + ": " +
                unknown_type(path,
                             ".obj .ply .off .stl .gltf .glb .fbx .dae .zae .3ds .3mf .x3d "
                             ".pcd .xyz .pts .txt .asc") +
                (is_usd ? "; export USD as .glb" : ""));
        }
    }
}

bool holds_points_only(FileType type)
{
    return type == FileType::xyz || type == FileType::pcd;
}

/// All that such a file can hold is a mesh.
bool has_faces(FileType type)
{
    return is_gltf(type) || type == FileType::stl || type == FileType::foreign;
}

constexpr const char* kLosesFaces = "a mesh cannot be written as points alone, use .ply";

WrittenFile contents_for(const fs::path& path, const Scene& scene,
                         std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    switch (type_of(path)) {
        case FileType::obj:
            return obj_contents(path, scene, occlusion, options);
        case FileType::off:
            return off_contents(scene, occlusion, options);
        case FileType::ply:
            return ply_contents(path, scene, occlusion, options);
        case FileType::pcd:
            return pcd_contents(scene, occlusion, options);
        case FileType::xyz:
            return xyz_contents(path, scene, occlusion, options);
        default:
            return gltf_contents(path, scene, occlusion, options);
    }
}

/// Whether the result with a map that would be written to `output` is there already, with its map.
bool is_of_result(const fs::path& output)
{
    const std::string picture = map_file_of(output)->filename().string();
    switch (type_of(output)) {
        case FileType::obj:
            return is_our_materials(*map_materials_of(output), picture);
        case FileType::ply:
            return names_our_texture(output, picture);
        default:
            return names_our_picture(output, encode_uri(picture));
    }
}

/// Throws SettingsError where a triangle of the scene would have no place to look up.
void check_places(const Scene& scene, const UvSet& uvs)
{
    const bool of_vertices = uvs.corners.empty();
    require(of_vertices ? uvs.values.size() == scene.positions.size()
                        : uvs.corners.size() == scene.triangles.size(),
            "new texture coordinates are one for each vertex, or for each corner of a triangle");
    require(std::ranges::all_of(uvs.values,
                                [](const glm::dvec2& uv) { return std::isfinite(uv.x + uv.y); }),
            "new texture coordinates are finite");
    require(std::ranges::all_of(uvs.corners,
                                [&](const glm::uvec3& corner) {
                                    const auto is_there = [&](std::uint32_t uv) {
                                        return uv < uvs.values.size() || uv == UvSet::kNone;
                                    };
                                    return is_there(corner.x) && is_there(corner.y) &&
                                           is_there(corner.z);
                                }),
            "a corner of a triangle has texture coordinates that there are not");
}

}  // namespace

Scene read_scene(const fs::path& path, const ReadOptions& options)
{
    Scene scene = read_any(path, options);
    scene.name = path.filename().string();
    return scene;
}

void check_output(const fs::path& input, const fs::path& output)
{
    const auto refuse = [&](const std::string& fault) {
        throw InputError(output.string() + ": " + fault);
    };
    const FileType type = type_of(output);
    if (type == FileType::stl)
        refuse("STL has no place for occlusion, use .ply");
    if (type == FileType::foreign)
        refuse("such files are read, not written, use .ply, .obj or .glb");
    if (type == FileType::unknown)
        refuse(unknown_type(output, ".ply .obj .off .gltf .glb .pcd .xyz .pts .txt .asc"));
    if (is_gltf(type) && holds_points_only(type_of(input)))
        refuse("points alone are not written as glTF, use .ply");
    if (holds_points_only(type) && has_faces(type_of(input)))
        refuse(kLosesFaces);
    check_writable(output);
}

void check_output(const Scene& scene, const fs::path& output)
{
    if (holds_points_only(type_of(output)) && !scene.triangles.empty())
        throw InputError(output.string() + ": " + kLosesFaces);
}

std::vector<std::string> write_scene(const fs::path& path, const Scene& scene,
                                     std::span<const Occlusion> occlusion,
                                     const WriteOptions& options)
{
    require(occlusion.size() == scene.positions.size(),
            "writing takes one answer per vertex: there are " +
                std::to_string(scene.positions.size()) + " vertices and " +
                std::to_string(occlusion.size()) + " answers");
    const bool covered =
        scene.parts.empty() ||
        scene.parts.back().first_vertex + scene.parts.back().vertex_count == scene.positions.size();
    if (!covered)
        throw InputError(path.string() + ": the scene's parts do not cover its vertices");
    check_output(path, path);
    check_output(scene, path);
    WrittenFile written = contents_for(path, scene, occlusion, options);
    write_atomically(path, written.contents);
    return std::move(written.notes);
}

std::optional<fs::path> map_file_of(const fs::path& output)
{
    const FileType type = type_of(output);
    if (type != FileType::gltf && type != FileType::obj && type != FileType::ply)
        return std::nullopt;
    return output.parent_path() / (output.stem().string() + ".ao.png");
}

std::optional<fs::path> map_materials_of(const fs::path& output)
{
    if (type_of(output) != FileType::obj)
        return std::nullopt;
    return output.parent_path() / (output.stem().string() + ".ao.mtl");
}

void check_output_with_map(const fs::path& input, const fs::path& output)
{
    const FileType type = type_of(output);
    if (!is_gltf(type) && type != FileType::obj && type != FileType::ply)
        throw InputError(output.string() +
                         ": a map goes into .glb, .gltf, .obj and .ply only, "
                         "use .png, .tif or .exr for the map alone");
    check_output(input, output);
    std::error_code error;
    for (const std::optional<fs::path>& file : {map_file_of(output), map_materials_of(output)}) {
        if (!file || !fs::exists(fs::symlink_status(*file, error)))
            continue;
        if (!is_of_result(output))
            throw InputError(file->string() + ": exists and is of no result at " +
                             output.filename().string() + ", which would replace it" +
                             (type == FileType::gltf ? "; use .glb" : ""));
        check_writable(*file);
    }
}

std::vector<std::string> write_scene_with_map(const fs::path& path, const Scene& scene,
                                              const OcclusionMap& map, const WriteOptions& options)
{
    check_output_with_map(path, path);
    if (map.uvs)
        check_places(scene, *map.uvs);
    else if (!is_gltf(type_of(path)) &&
             (map.uv_set >= scene.uvs.size() || scene.uvs[map.uv_set].empty()))
        throw InputError(path.string() + ": the mesh has no texture coordinates " +
                         std::to_string(map.uv_set) + ", which a map is to lie over");
    std::vector<std::pair<fs::path, std::string_view>> files;
    if (const std::optional<fs::path> file = map_file_of(path))
        files.emplace_back(*file, map.png);
    WrittenFile written;
    ObjWithMap obj;
    if (const std::optional<fs::path> file = map_materials_of(path)) {
        obj = obj_contents_with_map(path, scene, map, options);
        files.emplace_back(*file, obj.materials);
        written = {std::move(obj.contents), std::move(obj.notes)};
    } else if (type_of(path) == FileType::ply) {
        written = ply_contents_with_map(path, scene, map, options);
    } else {
        written = gltf_contents_with_map(path, scene, map, options);
    }
    files.emplace_back(path, written.contents);
    std::vector<fs::path> added;
    std::error_code error;
    try {
        for (const auto& [file, contents] : files) {
            if (!fs::exists(file, error))
                added.push_back(file);
            write_atomically(file, contents);
        }
    } catch (...) {
        for (const fs::path& file : added)
            fs::remove(file, error);
        throw;
    }
    return std::move(written.notes);
}

void check_output_with_blended_map(const fs::path& input, const fs::path& output)
{
    if (!is_gltf(type_of(output)))
        throw InputError(output.string() + ": blended charts go into .glb and .gltf only");
    check_output(input, output);
}

std::vector<std::string> write_scene_with_blended_map(const fs::path& path, const Scene& scene,
                                                      const BlendedMap& map,
                                                      const WriteOptions& options)
{
    check_output_with_blended_map(path, path);
    for (const UvSet& uvs : map.uvs)
        check_places(scene, uvs);
    WrittenFile written = gltf_contents_with_blended_map(path, scene, map, options);
    write_atomically(path, written.contents);
    return std::move(written.notes);
}

}  // namespace surfelao
