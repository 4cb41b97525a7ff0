/// gltf_asset.h: a glTF file as it lies on the disk: the JSON document and the bytes of its
/// buffers. Internal to the glTF reader and writer.
#pragma once

#include "files/gltf_accessor.h"
#include "files/scene_io.h"
#include "surfels/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// Padding is less than this. So many bytes a buffer may lack, and a view may end behind its
/// buffer: some exporters count the padding, but do not write it.
inline constexpr std::size_t kMostPadding = 4;

/// One entry of the document's `buffers`.
struct GltfBuffer {
    std::shared_ptr<const std::string> contents;  ///< of its uri; buffers with one file share it
    std::string_view bytes;  ///< byteLength bytes; empty: has no data (see below)
};

/// Scale, then rotation (a unit quaternion x y z w), then translation, as of nodes and instances.
struct GltfPlacement {
    glm::dvec3 translation{0.0};
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};
    glm::dvec3 scale{1.0};
};

/// A node's mesh, or one of its instances, in the scene.
struct GltfUse {
    std::size_t node = 0;
    std::size_t mesh = 0;
    std::optional<GltfPlacement> instance;  ///< seen from the node (EXT_mesh_gpu_instancing)
};

/// The triangles of a primitive that a scene has.
struct GltfTriangles {
    std::size_t primitive = 0;  ///< of the part's mesh
    std::uint32_t first = 0;    ///< of the scene
    std::uint32_t count = 0;
};

/// What the writer knows of a Part.
struct GltfPart {
    std::size_t use = 0;       ///< into GltfAsset::uses
    glm::dmat3 to_world{1.0};  ///< the linear part of mesh space -> world; not for skinned parts
    /// Skinned parts: the same per vertex, at any scale; empty for others.
    std::vector<glm::mat3> vertices_to_world;
    std::vector<GltfTriangles> primitives;  ///< in the order of the triangles
    /// For each triangle of the part: the last two corners have changed places, under a mirror.
    std::vector<bool> turned;
};

/// Whether something of these triangles was baked (WriteOptions::unbaked).
[[nodiscard]] bool is_baked(const GltfTriangles& triangles, const std::vector<bool>& unbaked);

/// Everything a writer needs to hand the file back with attributes added: without what an earlier
/// bake has added (gltf_old_results.h).
struct GltfAsset : SourceAsset {
    GltfAsset();
    ~GltfAsset() override;
    GltfAsset(const GltfAsset&) = delete;  // the views below point into `file` and `buffers`
    GltfAsset& operator=(const GltfAsset&) = delete;

    std::filesystem::path path;
    std::string file;            ///< a GLB as read; empty for text, of which nothing else is needed
    std::size_t byte_count = 0;  ///< of the file and its buffers
    std::unique_ptr<nlohmann::json> document;    ///< an object
    std::string_view bin;                        ///< the binary chunk of a GLB; empty without one
    std::vector<std::string_view> other_chunks;  ///< of a GLB: neither JSON nor BIN, with headers
    std::optional<Moment> moment;    ///< at which the scene stands; empty: its default pose
    bool is_played = false;          ///< an animation is: then no note says that none is
    std::vector<std::string> notes;  ///< what was let pass in all that, for Scene::notes
    std::vector<GltfBuffer> buffers;
    std::map<std::size_t, GltfAccessor> colors;  ///< COLOR_0 by accessor, of all parts
    /// Per mesh that the scene uses and primitive: the first primitive that shares all its vertices
    /// (Part::primitive), or -1 where it draws no triangles. Empty for other meshes.
    std::vector<std::vector<std::int32_t>> group_of_primitive;
    std::vector<GltfUse> uses;    ///< in the order of the parts; each has one at least
    std::vector<GltfPart> parts;  ///< as Scene::parts

    /// Per use, whether something of it was baked.
    [[nodiscard]] std::vector<bool> baked_uses(const std::vector<bool>& unbaked) const;
    [[nodiscard]] BaseColors base_colors() const override;  // gltf_base_colors.cpp
    [[nodiscard]] bool has_openings() const override;       // the same
    [[nodiscard]] std::optional<std::uint32_t> occlusion_uvs() const override;  // the same
};

/// Takes the container apart, parses the document and loads all buffers into `asset`. A buffer
/// without a uri that is not the binary chunk (its contents come from an extension) has no bytes;
/// using it is the fault.
///
/// A GLB whose chunks are not padded, or whose header has another length than the file, is taken by
/// its chunks: what is cut shows in them. Zeros behind the JSON are padding.
///
/// Throws InputError: cut, not glTF 2, not JSON, nested deeper than 256 levels, a buffer that is
/// missing, shorter than declared, or outside the file's folder (gltf_uri.h).
void load_gltf_asset(const std::filesystem::path& path, std::string contents, GltfAsset& asset);

/// The length of a mesh's entry in the document, written close together.
[[nodiscard]] std::size_t mesh_text_size(const GltfAsset& asset, std::size_t mesh);

/// The same for what the instances of a node take over from it: its name and weights.
[[nodiscard]] std::size_t node_text_size(const GltfAsset& asset, std::size_t node);

/// Whether the list holds the name; an entry that ends in '_' stands for all that begin with it.
[[nodiscard]] bool is_listed(std::string_view name, std::span<const std::string_view> list);

/// Text out of the file for use in a message: cut to a bearable length, between characters.
[[nodiscard]] std::string shortened(std::string_view text);

/// Throws InputError: "model.gltf: element fault". The fault begins with a verb.
[[noreturn]] void fail_gltf(const std::filesystem::path& path, std::string_view element,
                            std::string_view fault);

}  // namespace surfelao
