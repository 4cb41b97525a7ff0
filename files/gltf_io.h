/// gltf_io.h: glTF 2.0 scenes, .gltf and .glb (told apart by content, not by name).
///
/// Read: the default scene (else the first; a file without scenes: all root nodes), every node with
/// a mesh, triangles, strips and fans with or without indices of any type, sparse, normalised and
/// interleaved accessors (KHR_mesh_quantization), data URIs and external buffers. Positions are
/// transformed in double precision; under a mirroring node the winding is turned, so that the
/// outside stays outside. Points and lines are left out, images are not looked at.
///
/// The scene stands as a viewer shows it before any animation is played, or at a moment of one
/// (gltf_animation.h):
///   morph targets    with the node's weights, else the mesh's; weights that are missing are 0
///   skins            the joints move the mesh, its node does not. Weights need not sum up to 1; a
///                    vertex without any follows its first joint. JOINTS_1 and so on count too
///   hidden nodes     (KHR_node_visibility) are left out with all below them
///   instances        (EXT_mesh_gpu_instancing) are uses of the mesh like those of nodes
///   CESIUM_RTC       is left out: it moves everything alike
/// Scene::notes says what is not honoured: animations that are not played, see-through materials,
/// points and lines.
///
/// Normals are those of NORMAL at unit length, moved along with morph targets, joints and nodes (by
/// the inverse transpose); zero where a part has none or what it has is no number. Tangents are
/// those of TANGENT in the same way, but along the matrix itself, and their sign turns under a
/// mirror.
///
/// Texture coordinates are those of TEXCOORD_0 to TEXCOORD_7 as sets 0 to 7, of any type, each use
/// of a mesh at the same places of the map. KHR_texture_transform is a material's matter and not
/// applied. A primitive without a set has none at its corners; of sets that nobody has those below
/// the last one are empty.
///
/// Of a file that an earlier bake has made the original is read (gltf_old_results.h): its own
/// vertices, materials and texture coordinates.
///
/// A primitive becomes one Part per use of its mesh, with all vertices of its POSITION accessor;
/// primitives of one mesh that share all accessors their vertices come from (POSITION, NORMAL,
/// TANGENT, joints, weights, targets, but not texture coordinates) are one Part (Part::primitive is
/// the first of them).
///
/// Refused are compressed geometry (KHR_draco_mesh_compression, EXT_meshopt_compression without
/// plain data), and any extension that the file requires unless it is known to leave triangles
/// alone or to be read here (gltf_extensions.cpp lists them).
///
/// Let pass and counted in Scene::notes is what breaks the specification and leaves the triangles
/// clear: a GLB without padding or of another length than it says (gltf_asset.h); byteStride 0
/// (taken as none), of indices, or beyond 252; views and buffers that count padding which is not
/// there; float accessors that are normalized; primitives without POSITION or with fewer than three
/// corners; positions that are not finite in no triangle (gltf_pose.h).
///
/// The file is taken as hostile: every index, offset, count, stride and type is checked before use,
/// and what stands after the whole file has been multiplied by its nodes is bounded (see
/// kInstancingBase).
#pragma once

#include "files/scene_io.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace surfelao {

/// A scene may have kInstancingBase + kInstancingPerByte * (bytes of the file and its buffers)
/// vertices, as many triangles, as many displacements by morph targets and joints, and as many
/// bytes of JSON in the copies of meshes that a writer makes. Nodes and instances that use a mesh
/// again and again can multiply a small file without end; beyond this it is refused.
inline constexpr std::uint64_t kInstancingBase = 1u << 23;
inline constexpr std::uint64_t kInstancingPerByte = 16;

/// `contents` is the file at `path`; the path is for messages, and its folder is where external
/// buffers are looked for. Throws InputError with one sentence that names file, element and fault.
/// O(bytes + vertices).
[[nodiscard]] Scene read_gltf(const std::filesystem::path& path, std::string contents,
                              const std::optional<Moment>& moment = {}, bool is_played = false);

/// The file that `scene` was read from (read_gltf) with new vertex attributes, one Occlusion per
/// scene vertex, as it is to stand at `path` (whose extension says whether it is a .glb):
///
///   _OCCLUSION    SCALAR float, 0 = open, 1 = closed (occlusion.h)
///   _BENT_NORMAL  VEC3 float, unit length, in the mesh's own space like NORMAL: the normal matrix
///                 of the node (of a skin: the joints) turns it into world space. Zero where there
///                 is none, and where the mesh is flattened so that no direction is left.
///   COLOR_0       as options.colors says: VEC4 float, linear unless options.encoding is srgb.
///   Alpha
///                 is the file's own, 1 where it has none; bent normals are those of world space,
///                 as in a .ply
///   _OWN_COLOR    where COLOR_0 is ours and the file had one: the accessor that it had
///
/// VertexColors::automatic shows the occlusion in every primitive, in the way that leaves its looks
/// alone:
///   - without colours (or all white) and without textures of colour, emission or occlusion:
///     COLOR_0 = visibility, which viewers multiply with the material's colour
///   - else: an `occlusionTexture`, where the specification puts ambient occlusion. The picture is
///     a ramp from 0 to 1, and a new set TEXCOORD_n (VEC2 float, v = .5), the first that is
///     free, looks up the visibility in it, exactly. The material becomes a copy where others use
///     it too
///   - a material that has an occlusionTexture keeps it
/// A note counts the last two kinds. Where colours or textures are added, primitives without a
/// material get a plain one, white and no metal: without one Blender shows no colours, and others
/// show metal. occlusionTexture darkens ambient light only. three.js follows any of the first four
/// sets; Godot two, and before its change 96748 only the first, where the file's own coordinates
/// stand: there and in Blender, which shows none, ask for `shaded`.
///
/// Everything else is handed back: materials, textures, animations, nodes, extensions, extras,
/// unknown GLB chunks; keys of JSON objects come out sorted. A mesh that several nodes use is
/// listed once per use, as each has its own occlusion; the copies share all accessors but the new
/// ones. Nodes outside the scene that was read and hidden ones keep the mesh as it was. Instances
/// of a node (EXT_mesh_gpu_instancing) become nodes below it, each with a mesh of its own, and
/// stand where they stood (gltf_uses.h).
///
/// .glb: one file with one binary chunk; external buffers move into it, external images as well
/// where they lie in the model's folder or below.
/// .gltf: the new data stand in the file as a data URI; other buffers and images stay where they
/// are. In another folder their URIs are turned so that they are found from there; a buffer that
/// this reader would refuse from there (gltf_uri.h) becomes a data URI. URIs that remain come out
/// well formed (no backslashes, no blanks); those of files that are not there stay as they are, and
/// a note names them.
///
/// A bake of a result gives the bytes that a bake of the original gives, whatever the first one was
/// asked for.
///
/// options.mark stands as the string `surfelao` in asset.extras (maker_mark.h).
///
/// Equal input gives equal bytes. Throws InputError when the scene did not come from glTF, when a
/// colour to be multiplied is not finite, and when a .glb would exceed the format's 4 GiB.
[[nodiscard]] WrittenFile gltf_contents(const std::filesystem::path& path, const Scene& scene,
                                        std::span<const Occlusion> occlusion,
                                        const WriteOptions& options = {});

/// The same with a map in place of attributes. Each material that triangles of the scene use and
/// whose primitives have TEXCOORD_n, n = map.uv_set, gets the map as occlusionTexture; one that
/// something else uses too, or that has another occlusionTexture, stays as it is and the primitives
/// get a copy. A mesh that several nodes use stays one: they share the map as they share the
/// coordinates. Primitives without a material get a plain one; without TEXCOORD_n they are left
/// alone. Notes count those, and the materials that had another occlusionTexture.
///
/// .glb: the picture stands in the binary chunk. .gltf: its URI is that of map_file_of(path), which
/// is left to the caller to write; several pictures (map.more_pngs), each for materials of its own,
/// stand in the file.
///
/// New coordinates (map.uvs) go to the first set that a primitive does not have, TEXCOORD_n, and
/// each use of a mesh has its own: meshes and instances are taken apart as for values at vertices.
/// A vertex whose corners lie at several places is cut (gltf_cuts.h): the first vertices of a
/// primitive are those that it had, in their order, and copies with all attributes and morph
/// targets, bit by bit, stand behind them. Strips, fans and primitives without indices become lists
/// of indexed triangles then; indices get 32 bits where they must. Primitives of a part go on
/// sharing their vertices. What was there before the cut stays in the file, unused, for a later
/// bake: so much the file grows. Primitives of which no corner has a place are left alone. The
/// sampler does not repeat.
///
/// Baking a result again gives what baking the original gives, in every way (but instances that a
/// bake has made nodes of stay so). options.colors and options.encoding are not asked for. Throws
/// InputError like gltf_contents(), where no primitive has TEXCOORD_n or a place in the map, and
/// where an attribute of what is to be cut has not one element for each vertex. map.uvs must have
/// the sizes that write_scene_with_map() asks for.
[[nodiscard]] WrittenFile gltf_contents_with_map(const std::filesystem::path& path,
                                                 const Scene& scene, const OcclusionMap& map,
                                                 const WriteOptions& options = {});

/// The same with a map of three pages that fade into each other, each with a set of coordinates of
/// its own: the first three that are free. No viewer but ours knows such maps: the pictures are
/// textures of the file (in a .gltf too), which the primitives' materials, copies of the file's,
/// name in their extras with the sets, page by page:
///
///     "extras": {"surfelao": {"blended": [{"index": 5, "texCoord": 1}, ...], "original": 0}}
///
/// A corner that is not on a page is at 0, 0 there, as are the others of its triangle. What else
/// the materials have stays, an occlusionTexture too.
[[nodiscard]] WrittenFile gltf_contents_with_blended_map(const std::filesystem::path& path,
                                                         const Scene& scene, const BlendedMap& map,
                                                         const WriteOptions& options = {});

}  // namespace surfelao
