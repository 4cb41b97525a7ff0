/// gltf_added.h: the accessors, buffer views and bytes that a result adds to a glTF. Internal to
/// the glTF writer.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
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

/// An accessor that has taken the place of one of the file's, with more elements or other indices,
/// says so in its extras: its name is the file's (gltf_cuts.h).
void mark_replacement(nlohmann::json& accessor);
[[nodiscard]] bool is_replacement(const nlohmann::json& accessor);

/// The first set of texture coordinates that a primitive with these attributes does not have: n of
/// TEXCOORD_n.
[[nodiscard]] std::size_t free_set(const nlohmann::json& attributes);

/// Accessors whose elements have one size share a buffer view. The document must outlive it, and
/// gets no other buffer views meanwhile.
class AddedData {
public:
    explicit AddedData(nlohmann::json& document);

    /// Adds an accessor of `dimension` (1 to 4) floats per element and returns its index. Floats
    /// also where 16 bits would do: Godot 3.2 takes normalised integers for whole ones.
    std::size_t add_floats(std::size_t dimension, std::span<const float> values,
                           const char* name = nullptr);

    /// Adds an accessor like this one, but of these elements: `size` bytes each.
    std::size_t add_elements(nlohmann::json accessor, std::string_view bytes, std::size_t size);

    /// Adds an accessor of indices, of 16 bits where that is enough for so many vertices.
    std::size_t add_indices(std::span<const std::uint32_t> indices, std::size_t vertices);

    /// Adds a buffer view of bytes that are no elements and returns its index.
    std::size_t add_bytes(std::string_view bytes);

    /// Adds the buffer views and returns their bytes, which belong into `buffer` from `offset` on.
    [[nodiscard]] std::string finish(std::size_t buffer, std::size_t offset);

private:
    struct View {
        int target;          ///< what its elements are; 0: it has none
        std::size_t stride;  ///< bytes from one to the next
        std::string bytes;
    };

    /// Adds an accessor of elements that are in no view yet; append(bytes) puts them into one.
    template <class Append>
    std::size_t add_accessor(nlohmann::json accessor, int target, std::size_t stride,
                             const Append& append);

    nlohmann::json& document_;
    std::size_t first_view_;
    std::vector<View> views_;
};

}  // namespace surfelao
