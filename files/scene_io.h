/// scene_io.h: files of meshes and clouds in, the same with occlusion out.
///
/// Read: .obj .ply .off .stl .gltf .glb, those of foreign_io.h (.fbx .dae .zae .3ds .3mf .x3d) and
/// the clouds .pcd .xyz .pts .txt .asc (by extension, any
/// case); .ply, .obj and .off without faces are clouds too. Written: .ply .obj .off, .gltf/.glb for
/// a scene that came from glTF or through assimp (gltf_new.h makes such of meshes), and for clouds
/// .pcd .xyz .pts .txt .asc. The
/// file's own order and number of vertices are kept, also on non-manifold meshes and at seams (STL
/// has no vertices of its own: equal corners are one). No faces are invented.
#pragma once

#include "files/vertex_colors.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/scene.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// A moment of an animation of a file.
struct Moment {
    double seconds = 0.0;        ///< of the animation's own time
    std::string animation = {};  ///< its name, or its number from 0; empty: the first
    bool operator==(const Moment&) const = default;
};

struct ReadOptions {
    /// What the columns of a text cloud are, "x y z intensity r g b nx ny nz"; `-` and any other
    /// word: kept and not used (xyz_io.h). Empty: as they are found.
    std::string columns = {};
    /// glTF: as it is at this moment; empty: its default pose.
    std::optional<Moment> moment = {};
    /// glTF: who reads it plays an animation (motion.h); no note says that none is.
    bool is_played = false;
    /// Told 0 now and then while another program reads the file (foreign_io.h).
    Progress progress = {};
};

/// Throws SettingsError for columns that do not name x, y and z once each; empty is right.
void check_columns(const std::string& columns);

/// Reads a file. A file without faces is a cloud: a scene without triangles. Throws InputError with
/// one sentence that names file, element and fault for anything that is not a complete, finite,
/// consistent mesh or cloud; SettingsError for columns that make no point, for columns of a file
/// that is no text cloud, and for a moment of a file that is no glTF; Cancelled where
/// options.progress says so. Time and memory stay in proportion to the file's size, whatever its
/// counts claim.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

struct WriteOptions {
    VertexColors colors = VertexColors::automatic;  ///< vertex_colors.h
    Encoding encoding = Encoding::automatic;        ///< of the colours that are written
    std::string mark = {};  ///< who made the file, and how (maker_mark.h); empty: it says nothing
    /// Scene triangles that were not baked; empty: all were. glTF keeps primitives of such alone
    /// exactly as they are. In other formats a vertex has its occlusion in any case: there it is
    /// what the answers say, 0 for what nobody asked.
    std::vector<bool> unbaked = {};
};

/// A result as the writers of the formats make it.
struct WrittenFile {
    std::string contents;
    std::vector<std::string> notes;  ///< as Scene::notes: what became of the file's own things
};

/// Throws InputError when a scene from `input` could not be written to `output` at all: unknown
/// extension, STL, a glTF asked of points alone, points alone asked of STL or glTF, folder
/// missing or not writable, output is a folder. For use before any work is done.
void check_output(const std::filesystem::path& input, const std::filesystem::path& output);

/// The same, once the scene has been read: a mesh is not written as points alone.
void check_output(const Scene& scene, const std::filesystem::path& output);

/// Writes the scene with one Occlusion per scene vertex, in scene order. The file appears under its
/// name only when it is complete (written to a temporary name beside it, then renamed): on any
/// error an existing file is untouched and nothing is left behind. Throws SettingsError when the
/// number of answers is another one, InputError as check_output does, std::runtime_error when the
/// machine refuses (disk full). Returns notes on the result: colours of the file that hide the
/// occlusion or are shaded by it, other files that it names and that are not there.
std::vector<std::string> write_scene(const std::filesystem::path& path, const Scene& scene,
                                     std::span<const Occlusion> occlusion,
                                     const WriteOptions& options = {});

/// Occlusion as a texture over the file's own coordinates, or over new ones.
struct OcclusionMap {
    std::string png;           ///< a file's contents; red is the visibility, linear: 1 = open
    std::uint32_t uv_set = 0;  ///< of Scene::uvs: glTF's TEXCOORD_n
    /// New ones, in place of uv_set: finite, one for each corner or vertex (UvSet). As they are in
    /// files they are floats.
    std::optional<UvSet> uvs = {};
    /// Maps of the pages behind the first, over the same coordinates: in glTF only, without uvs.
    std::vector<std::string> more_pngs = {};
    /// Of each scene triangle: its page, 0 for `png`; the same for all triangles of a material.
    /// Empty: all lie on the first.
    std::vector<std::uint32_t> pages = {};
};

/// Where the map of a result at `output` stands: STEM.ao.png beside a .gltf, .obj or .ply; nothing
/// for a .glb, which holds it.
[[nodiscard]] std::optional<std::filesystem::path> map_file_of(const std::filesystem::path& output);

/// Where the materials of an .obj with a map stand: STEM.ao.mtl beside it; nothing for others.
[[nodiscard]] std::optional<std::filesystem::path> map_materials_of(
    const std::filesystem::path& output);

/// check_output() for a result with a map: glTF, .obj and .ply. Refused as well
/// is an output whose map_file_of() or map_materials_of() is there already, unless it is the one of
/// an earlier result that is there: the file is its user's.
void check_output_with_map(const std::filesystem::path& input, const std::filesystem::path& output);

/// write_scene() with a map in place of values at vertices (gltf_io.h, obj_io.h, ply_io.h); the
/// files of the map are written as well, before the mesh: new ones go again where that fails.
/// Throws InputError as check_output_with_map() does and where nothing in the file has the
/// coordinates; SettingsError where map.uvs does not fit the scene.
std::vector<std::string> write_scene_with_map(const std::filesystem::path& path, const Scene& scene,
                                              const OcclusionMap& map,
                                              const WriteOptions& options = {});

/// A map of three pages that fade into each other (atlas/layout.h): a file's contents and new
/// coordinates for each; UvSet::kNone for triangles that are not on a page.
struct BlendedMap {
    std::array<std::string, 3> pngs;  ///< as OcclusionMap::png
    std::array<UvSet, 3> uvs;
};

/// check_output() for a result with a blended map: glTF only.
void check_output_with_blended_map(const std::filesystem::path& input,
                                   const std::filesystem::path& output);

/// write_scene() with a blended map (gltf_io.h), which stands in the file. Throws InputError as
/// check_output_with_blended_map() does, SettingsError where the coordinates do not fit the scene.
std::vector<std::string> write_scene_with_blended_map(const std::filesystem::path& path,
                                                      const Scene& scene, const BlendedMap& map,
                                                      const WriteOptions& options = {});

}  // namespace surfelao
