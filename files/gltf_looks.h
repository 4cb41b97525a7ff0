/// gltf_looks.h: how a glTF's primitives show their occlusion: vertex colours and occlusion
/// textures. Internal to the glTF writer; gltf_io.h says what is done and why.
#pragma once

#include "files/gltf_added.h"
#include "files/gltf_asset.h"
#include "files/gltf_textures.h"
#include "files/scene_io.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

class GltfLooks {
public:
    /// The asset's colours and the document, without older results; all must outlive it.
    GltfLooks(nlohmann::json& document, const GltfAsset& asset, const WriteOptions& options,
              AddedData& added);

    /// Shows the values of one part in those of its primitives that share its vertices. The
    /// pointers must stay good until finish().
    void add(std::span<nlohmann::json* const> primitives, std::span<const Occlusion> values);

    /// Adds textures and materials, when all parts are there.
    void finish();

    /// A sentence on primitives that keep their looks; none where all show the occlusion as colour.
    [[nodiscard]] std::vector<std::string> notes() const;

private:
    [[nodiscard]] VertexColors decide(const nlohmann::json& primitive,
                                      std::optional<std::size_t> own);
    [[nodiscard]] bool is_white(std::size_t accessor);
    [[nodiscard]] std::size_t add_colors(VertexColors what, std::optional<std::size_t> own,
                                         std::span<const Occlusion> values);

    nlohmann::json& document_;
    const GltfAsset& asset_;
    const WriteOptions& options_;
    AddedData& added_;
    std::map<std::size_t, bool> white_;  // by accessor
    std::vector<nlohmann::json*> bare_;  // primitives without a material that have our colours
    std::vector<Occluded> textured_;
    std::size_t kept_colors_ = 0;    // primitives with colours of their own
    std::size_t kept_textures_ = 0;  // and with an occlusionTexture of their own
};

}  // namespace surfelao
