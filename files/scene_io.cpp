#include "files/scene_io.h"

#include "files/file_contents.h"
#include "files/file_type.h"
#include "files/gltf_io.h"
#include "files/obj_io.h"
#include "files/off_io.h"
#include "files/ply_io.h"
#include "files/stl_io.h"
#include "surfels/atomic_file.h"
#include "surfels/errors.h"

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

Scene read_any(const fs::path& path)
{
    const std::string name = path.string();
    switch (type_of(path)) {
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
            return read_gltf(path, read_contents(path, name));
        default:
            throw InputError(name + ": " + unknown_type(path, ".obj .ply .off .stl .gltf .glb"));
    }
}

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
        default:
            return gltf_contents(path, scene, occlusion, options);
    }
}

}  // namespace

Scene read_scene(const fs::path& path)
{
    Scene scene = read_any(path);
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
    if (type == FileType::unknown)
        refuse(unknown_type(output, ".ply .obj .off .gltf .glb"));
    if (is_gltf(type) && !is_gltf(type_of(input)))
        refuse("only a scene that was read from glTF can be written as glTF, use .ply or .obj");
    check_writable(output);
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
    WrittenFile written = contents_for(path, scene, occlusion, options);
    write_atomically(path, written.contents);
    return std::move(written.notes);
}

}  // namespace surfelao
