/// gltf_io.h: glTF 2.0 scenes, .gltf and .glb (told apart by content, not by name).
///
/// Read: the default scene (else the first; a file without scenes: all root nodes), every node with
/// a mesh, triangles, strips and fans with or without indices of any type, sparse, normalised and
/// interleaved accessors (KHR_mesh_quantization), data URIs and external buffers. Positions are
/// transformed in double precision; under a mirroring node the winding is turned, so that the
/// outside stays outside. Points and lines are left out, images are not looked at. Skinned and
/// morphed meshes stand as they are stored, moved by their node: no joint and no morph weight is
/// applied.
///
/// A primitive becomes one Part per node that uses its mesh, with all vertices of its POSITION
/// accessor; primitives of one mesh that share that accessor are one Part (Part::primitive is the
/// first of them).
///
/// Refused are compressed geometry (KHR_draco_mesh_compression, EXT_meshopt_compression without
/// plain data), EXT_mesh_gpu_instancing, and any other extension that the file requires unless it
/// is known to leave geometry alone (materials, textures, lights).
///
/// The file is taken as hostile: every index, offset, count, stride and type is checked before use,
/// and what stands after the whole file has been multiplied by its nodes is bounded (see
/// kInstancingBase).
#pragma once

#include "files/scene_io.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace surfelao {

/// A scene may have kInstancingBase + kInstancingPerByte * (bytes of the file and its buffers)
/// vertices, as many triangles, and as many bytes of JSON in the copies of meshes that a writer
/// makes. Nodes that use a mesh again and again can multiply a small file without end; beyond this
/// it is refused.
inline constexpr std::uint64_t kInstancingBase = 1u << 22;
inline constexpr std::uint64_t kInstancingPerByte = 16;

/// `contents` is the file at `path`; the path is for messages, and its folder is where external
/// buffers are looked for. Throws InputError with one sentence that names file, element and fault.
/// O(bytes + vertices).
[[nodiscard]] Scene read_gltf(const std::filesystem::path& path, std::string contents);

/// The file that `scene` was read from (read_gltf) with new vertex attributes, one Occlusion per
/// scene vertex, as it is to stand at `path` (whose extension says whether it is a .glb):
///
///   _OCCLUSION    SCALAR float, 0 = open, 1 = closed (occlusion.h)
///   _BENT_NORMAL  VEC3 float, unit length, in the mesh's own space like NORMAL: the normal matrix
///   of
///                 the node turns it into world space. Zero where there is none, and where the node
///                 flattens the mesh so that no direction is left.
///   COLOR_0       when options.colors: VEC3 float, visibility as grey. Where the file has vertex
///                 colours they are multiplied by the visibility, alpha kept (so baking twice
///                 darkens twice).
///
/// Everything else is handed back: materials, textures, animations, nodes, extensions, extras,
/// unknown GLB chunks; keys of JSON objects come out sorted. A mesh that several nodes use is
/// listed once per use, as each has its own occlusion; the copies share all accessors but the new
/// ones. Nodes outside the scene that was read keep the mesh as it was.
///
/// .glb: one file with one binary chunk; external buffers move into it, external images as well
/// where they lie in the model's folder (another image keeps its uri).
/// .gltf: the new data stand in the file as a data URI. Beside the original the other buffers and
/// images stay where they are; in another folder they become data URIs too, so that the file opens.
///
/// What an earlier bake has added is replaced (gltf_old_results.h): baking twice gives the same
/// file as baking once, but for colours.
///
/// options.mark stands as the string `surfelao` in asset.extras (maker_mark.h).
///
/// Equal input gives equal bytes. Throws InputError when the scene did not come from glTF, when a
/// colour to be multiplied is not finite, and when a .glb would exceed the format's 4 GiB.
[[nodiscard]] std::string gltf_contents(const std::filesystem::path& path, const Scene& scene,
                                        std::span<const Occlusion> occlusion,
                                        const WriteOptions& options = {});

}  // namespace surfelao
