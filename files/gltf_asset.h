/// gltf_asset.h: a glTF file as it lies on the disk: the JSON document and the bytes of its
/// buffers. Internal to the glTF reader and writer.
#pragma once

#include "files/gltf_accessor.h"
#include "surfels/scene.h"

#include <glm/mat3x3.hpp>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// One entry of the document's `buffers`.
struct GltfBuffer {
    std::shared_ptr<const std::string> contents;  ///< of its uri; buffers with one file share it
    std::string_view bytes;  ///< byteLength bytes; empty: has no data (see below)
};

/// Everything a writer needs to hand the file back with attributes added.
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
    std::vector<GltfBuffer> buffers;
    std::map<std::size_t, GltfAccessor> colors;  ///< COLOR_0 by accessor index, of all parts
    std::vector<glm::dmat3> part_matrices;  ///< per Part: the linear part of mesh space -> world
};

/// Takes the container apart, parses the document and loads all buffers into `asset`. A buffer
/// without a uri that is not the binary chunk (its contents come from an extension) has no bytes;
/// using it is the fault.
///
/// Throws InputError: cut, not glTF 2, not JSON, nested deeper than 256 levels, a buffer that is
/// missing, shorter than declared, or outside the file's folder.
void load_gltf_asset(const std::filesystem::path& path, std::string contents, GltfAsset& asset);

/// The length of a mesh's entry in the document, written close together.
[[nodiscard]] std::size_t mesh_text_size(const GltfAsset& asset, std::size_t mesh);

/// Text out of the file for use in a message: cut to a bearable length, between characters.
[[nodiscard]] std::string shortened(std::string_view text);

/// Throws InputError: "model.gltf: element fault". The fault begins with a verb.
[[noreturn]] void fail_gltf(const std::filesystem::path& path, std::string_view element,
                            std::string_view fault);

}  // namespace surfelao
