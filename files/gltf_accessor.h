/// gltf_accessor.h: the values behind a glTF accessor. Internal to the glTF reader and writer.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// glTF's componentType.
enum class GltfComponent : std::uint16_t {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126,
};

/// 1, 2 or 4 bytes.
[[nodiscard]] std::size_t size_of(GltfComponent component);

/// Whether indices may be of this type: uint8, uint16 or uint32.
[[nodiscard]] bool is_index_type(GltfComponent component);

/// The largest value of an index type.
[[nodiscard]] std::uint32_t largest_index(GltfComponent component);

/// Where the elements lie. The bytes need no alignment.
/// Invariant (the reader has checked it): the last element ends inside `bytes`.
struct GltfAccessor {
    std::string_view bytes;  ///< from the first element on; not used when `zero`
    std::size_t stride = 0;  ///< bytes from one element to the next
    std::size_t count = 0;
    GltfComponent component = GltfComponent::float32;
    int dimension = 1;              ///< components per element
    std::size_t element_bytes = 0;  ///< with the padding between a matrix' columns
    bool normalized = false;        ///< integers stand for [-1, 1] or [0, 1]
    bool zero = false;              ///< without a bufferView: all zero, but for the sparse elements

    std::size_t sparse_count = 0;
    std::string_view sparse_indices;  ///< sparse_count whole numbers, close together
    GltfComponent sparse_component = GltfComponent::uint32;
    std::string_view sparse_values;  ///< sparse_count elements, close together
};

/// What is wrong with the values of an accessor; what() lacks the element's name.
struct AccessorError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// All components of all elements, one element after the other: count * dimension numbers. A MAT4
/// is 16 of them, column by column; matrices of types that need padding are not read rightly.
/// Throws AccessorError on a value that is not finite and on bad sparse indices.
[[nodiscard]] std::vector<double> read_numbers(const GltfAccessor& accessor);

/// The bytes of all elements, close together. Throws AccessorError on bad sparse indices.
[[nodiscard]] std::string read_elements(const GltfAccessor& accessor);

/// Asks for three components of any type; the values may be not finite. Throws AccessorError on bad
/// sparse indices.
[[nodiscard]] std::vector<glm::dvec3> read_vectors(const GltfAccessor& accessor);

/// The same for two components.
[[nodiscard]] std::vector<glm::dvec2> read_pairs(const GltfAccessor& accessor);

/// The same for four.
[[nodiscard]] std::vector<glm::dvec4> read_quadruples(const GltfAccessor& accessor);

/// Asks for three components of any type (alpha is then 1) or four. Throws like read_numbers.
[[nodiscard]] std::vector<glm::dvec4> read_colors(const GltfAccessor& accessor);

/// Asks for one component of an unsigned type. Throws AccessorError on bad sparse indices.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const GltfAccessor& accessor);

}  // namespace surfelao
