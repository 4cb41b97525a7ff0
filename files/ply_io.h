/// ply_io.h: the Stanford polygon format, ascii and binary of both byte orders.
///
/// Read: element `vertex` with scalar properties x, y, z of any type, and nx, ny, nz if all three
/// are there (the normals of the vertices, any numbers), and s and t, u and v, texture_u and
/// texture_v, or texture_s and texture_t (texture coordinates); element `face` with the list
/// `vertex_indices` or `vertex_index`, and `texcoord`, two numbers for each corner, before which
/// the vertices' own texture coordinates do not count (MeshLab writes both; a face without has
/// none). v runs up, and what is no number there is nan. Element `tristrips` (a strip ends at -1,
/// triangles that use a vertex twice only turn the strip and are left out). Other elements and
/// properties are passed over. In ascii files every row stands on a line of its own. Bytes after
/// the last element are ignored. A header line that begins with `Created` is a comment:
/// Blender 2.47 wrote it so. Faces of fewer than three corners are passed over and counted in
/// Scene::notes, as are vertices without a finite place that no face uses (mesh_source.h) and lists
/// `texcoord` of another length.
///
/// Without any face it is a cloud of points, and Scene::viewpoint is what a comment `viewpoint X Y
/// Z` says, or else view_px, view_py, view_pz of the first row of element `camera` (MeshLab, PCL);
/// 0 0 0 is none.
#pragma once

#include "files/scene_io.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// file_name is what faults are reported of; contents is the file. Faults name the line in the
/// header and in ascii data, and the element and row (counted from 0) in all data.
[[nodiscard]] Scene read_ply(const std::string& file_name, std::string contents);

/// The scene as PLY with the vertex properties `float occlusion`, `float bent_nx bent_ny bent_nz`
/// and colours (vertex_colors.h); `automatic` keeps those of the file, all of them white: shades.
///
/// A scene that came from PLY gives its own file with the new properties behind the others of the
/// vertex (old ones of the same names go) and nothing else changed: same format, order, comments,
/// other properties and elements. The file's own colours (`red green blue`, `diffuse_red ...`, `r g
/// b`, `diffuse_r ...` of any type: of 0 to 255, ushort 65535, float and double 1, or 255 where one
/// is above 2) keep their place and their type; where others are shown there, they stand last, as
/// `own_red own_green own_blue`. Alpha is left alone. A file without any gets `uchar red green
/// blue`. Seen from the folder of `path`, comments `TextureFile` name the same files as before.
/// Any other scene gives binary_little_endian with the polygons of its source, normals where each
/// vertex has one (`float nx ny nz`), and its colours; a cloud with all single numbers that a point
/// has in its source, and its viewpoint.
/// Coordinates are float, or double where rounding to float would move some vertex by more than
/// kFloatSlack of the bounding box's diagonal (small things far from the origin).
/// options.mark: a comment behind the line `format`, in the place of an older one (maker_mark.h).
[[nodiscard]] WrittenFile ply_contents(const std::filesystem::path& path, const Scene& scene,
                                       std::span<const Occlusion> occlusion,
                                       const WriteOptions& options = {});

/// The file that a scene was read from, without anything that a bake has added.
[[nodiscard]] std::string original_ply(const Scene& scene);

/// The scene as PLY with `comment TextureFile` of map_file_of(path), in place of other such
/// comments, as MeshLab reads it; of colours the file's own.
///
/// A scene that came from PLY gives its own file as above. Over its own coordinates its rows stay
/// as they are. With new ones (map.uvs) each face has them in a last property `list uchar float
/// texcoord`, u and v of each corner, v up, none for a face without; `texcoord` and `texnumber` of
/// its own go. Polygons become their triangles, each with all other properties: MeshLab loads no
/// others with such a list. Where it has triangle strips, and for any other scene, a new file is
/// made, of coordinates, colours and faces, over map.uvs or the scene's own set map.uv_set.
[[nodiscard]] WrittenFile ply_contents_with_map(const std::filesystem::path& path,
                                                const Scene& scene, const OcclusionMap& map,
                                                const WriteOptions& options = {});

/// Whether the .ply at `path` is the result of a bake that names this picture.
[[nodiscard]] bool names_our_texture(const std::filesystem::path& path, std::string_view picture);

/// What stands at the vertices of a new file behind their coordinates.
struct PlyValues {
    std::vector<std::string> properties;  ///< "float error"
    /// Appends the bytes of one vertex, in the order of the properties.
    std::function<void(std::string& row, std::size_t vertex)> append;
};

enum class PlyCoordinates {
    near_enough,  ///< float or double, as above
    exact,        ///< double
};

/// A picture that lies over the faces.
struct PlyTexture {
    std::string_view name;
    const UvSet& uvs;  ///< of each triangle of the scene
};

/// The scene with the polygons of its source as a new binary_little_endian file. With a texture:
/// as ply_contents_with_map().
[[nodiscard]] std::string new_ply(const Scene& scene, const PlyValues& values,
                                  std::string_view mark,
                                  PlyCoordinates coordinates = PlyCoordinates::near_enough,
                                  const PlyTexture* texture = nullptr);

/// The bytes of a number as a binary PLY holds them.
template <class Value>
void append_bytes(std::string& text, Value value, std::endian endian = std::endian::little)
{
    char bytes[sizeof(Value)];
    std::memcpy(bytes, &value, sizeof(Value));
    if (endian != std::endian::native)
        std::reverse(bytes, bytes + sizeof(Value));
    text.append(bytes, sizeof(Value));
}

/// Twice the rounding of a float as a share of the number: half an offset unit would be 1e-4.
inline constexpr double kFloatSlack = 1.2e-7;

}  // namespace surfelao
