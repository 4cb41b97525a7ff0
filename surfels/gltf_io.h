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
/// The file is taken as hostile: every index, offset, count, stride and type is checked before use,
/// and what stands after the whole file has been multiplied by its nodes is bounded (see
/// kInstancingBase).
#pragma once

#include "surfels/scene.h"

#include <cstdint>
#include <filesystem>

namespace surfelao {

/// A scene may have kInstancingBase + kInstancingPerByte * (bytes of the file and its buffers)
/// vertices, and as many triangles. Nodes that use a mesh again and again can multiply a small file
/// without end; beyond this it is refused.
inline constexpr std::uint64_t kInstancingBase = 1u << 24;
inline constexpr std::uint64_t kInstancingPerByte = 8;

/// Throws InputError with one sentence that names file, element and fault. O(bytes + vertices).
[[nodiscard]] Scene read_gltf(const std::filesystem::path& path);

}  // namespace surfelao
