/// gltf_mesh.h: what the meshes of a glTF are made of, checked. Internal to the glTF reader.
#pragma once

#include "files/gltf_resolve.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace surfelao {

/// Sets of texture coordinates that are read: a file might name its accessors any number of times.
inline constexpr std::size_t kMostUvSets = 8;
inline constexpr int kNoUvs = -1;

/// One primitive that draws triangles.
struct Primitive {
    std::size_t index;                     // in its mesh
    std::optional<NamedAccessor> indices;  // without: the vertices in order
    int mode;
    std::size_t triangle_count;
    /// Of TEXCOORD_0 and so on the accessors, in Group::uvs; kNoUvs where it has none.
    std::array<int, kMostUvSets> uvs;

    /// Vertices, or indices of them, that the triangles are made of: a list may hold one or two
    /// more.
    [[nodiscard]] std::size_t corner_count() const;
};

/// Displacements; one for each vertex.
struct MorphTarget {
    std::optional<NamedAccessor> positions;
    std::optional<NamedAccessor> normals;
    std::optional<NamedAccessor> tangents;
};

/// Four joints and their weights for each vertex: JOINTS_n and WEIGHTS_n.
struct InfluenceSet {
    NamedAccessor joints;
    NamedAccessor weights;
};

/// Primitives of one mesh that share their vertices, that is all of the following accessors but
/// those of texture coordinates: a part of the scene for each use of the mesh.
struct Group {
    NamedAccessor positions;
    std::optional<NamedAccessor> normals;
    std::optional<NamedAccessor> tangents;
    std::vector<MorphTarget> targets;
    std::vector<InfluenceSet> influences;
    std::vector<Primitive> primitives;
    /// Of each set the accessors of all primitives, by their index.
    std::array<std::map<int, NamedAccessor>, kMostUvSets> uvs;
};

/// The groups of one mesh; reads no element yet. The index of the first primitive of its group (-1:
/// draws no triangles) is noted for each primitive in asset.group_of_primitive, which has room for
/// all meshes; colours in asset.colors. Throws InputError for accessors of a wrong type or length.
/// O(size of its JSON).
[[nodiscard]] std::vector<Group> resolve_mesh(const tinygltf::Model& model, std::size_t mesh,
                                              GltfAsset& asset);

/// The same without a note in the asset.
[[nodiscard]] std::vector<Group> resolve_mesh(const tinygltf::Model& model, std::size_t mesh,
                                              const GltfAsset& asset);

}  // namespace surfelao
