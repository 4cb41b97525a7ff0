/// gltf_added.h: the accessors, buffer views and bytes that a result adds to a glTF. Internal to
/// the glTF writer.
#pragma once

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// Names of what is added under names of glTF's own (COLOR_0, textures, ...) begin so: by them a
/// later bake tells it from what is the file's (gltf_old_results.h).
inline constexpr const char* kAddedColors = "surfelao COLOR_0";
inline constexpr const char* kAddedCoordinates = "surfelao TEXCOORD";
inline constexpr const char* kAddedPicture = "surfelao occlusion";
inline constexpr const char* kAddedMaterial = "surfelao plain";

/// Whether an entry of the document has a name that begins like those.
[[nodiscard]] bool is_added(const nlohmann::json& entry);

/// Accessors whose elements have one size share a buffer view. The document must outlive it, and
/// gets no other buffer views meanwhile.
class AddedData {
public:
    explicit AddedData(nlohmann::json& document);

    /// Adds an accessor of `dimension` (1 to 4) floats per element and returns its index. Floats
    /// also where 16 bits would do: Godot 3.2 takes normalised integers for whole ones.
    std::size_t add_floats(std::size_t dimension, std::span<const float> values,
                           const char* name = nullptr);

    /// Adds a buffer view of bytes that are no elements and returns its index.
    std::size_t add_bytes(std::string_view bytes);

    /// Adds the buffer views and returns their bytes, which belong into `buffer` from `offset` on.
    [[nodiscard]] std::string finish(std::size_t buffer, std::size_t offset);

private:
    struct View {
        std::size_t stride;  ///< 0: no elements
        std::string bytes;
    };

    std::size_t add_accessor(std::size_t dimension, std::string_view bytes, std::size_t stride,
                             nlohmann::json accessor);

    nlohmann::json& document_;
    std::size_t first_view_;
    std::vector<View> views_;
};

}  // namespace surfelao
