#include "files/gltf_accessor.h"

#include "surfels/errors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

namespace surfelao {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little endian, and so is this");

template <typename T>
T load(const char* at)
{
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// Calls f with a value of the C++ type that `component` names.
template <typename F>
void with_type(GltfComponent component, F&& f)
{
    switch (component) {
        case GltfComponent::int8:
            return f(std::int8_t{});
        case GltfComponent::uint8:
            return f(std::uint8_t{});
        case GltfComponent::int16:
            return f(std::int16_t{});
        case GltfComponent::uint16:
            return f(std::uint16_t{});
        case GltfComponent::uint32:
            return f(std::uint32_t{});
        case GltfComponent::float32:
            return f(float{});
    }
}

/// Section 3.6.2.2 of the specification: c / 127, c / 255 and so on, not below -1.
template <typename T>
double to_real(T value, bool normalized)
{
    if constexpr (std::is_floating_point_v<T>) {
        return value;
    } else {
        return normalized ? std::max(value / double{std::numeric_limits<T>::max()}, -1.0) : value;
    }
}

/// Which elements the sparse values replace.
std::vector<std::uint32_t> sparse_targets(const GltfAccessor& accessor)
{
    GltfAccessor list;
    list.bytes = accessor.sparse_indices;
    list.component = accessor.sparse_component;
    list.stride = size_of(list.component);
    list.count = accessor.sparse_count;
    std::vector<std::uint32_t> targets = read_indices(list);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (targets[i] >= accessor.count)
            throw AccessorError("sparse index " + std::to_string(i) + " is " +
                                std::to_string(targets[i]) + ", but the accessor has " +
                                std::to_string(accessor.count) + " elements");
        if (i > 0 && targets[i] <= targets[i - 1])
            throw AccessorError("sparse indices do not increase at " + std::to_string(i));
    }
    return targets;
}

/// Stores `dimension` numbers for each of `count` elements, the i-th element's from place(i) on.
template <typename Place>
void load_elements(const GltfAccessor& accessor, const char* bytes, std::size_t stride,
                   std::size_t count, Place&& place)
{
    with_type(accessor.component, [&](auto sample) {
        using T = decltype(sample);
        for (std::size_t i = 0; i < count; ++i, bytes += stride) {
            double* const numbers = place(i);
            for (int k = 0; k < accessor.dimension; ++k)
                numbers[k] = to_real(load<T>(bytes + static_cast<std::size_t>(k) * sizeof(T)),
                                     accessor.normalized);
        }
    });
}

/// All elements, into count * dimension zeros.
void load_all(const GltfAccessor& accessor, double* numbers)
{
    const auto dimension = static_cast<std::size_t>(accessor.dimension);
    if (!accessor.zero)
        load_elements(accessor, accessor.bytes.data(), accessor.stride, accessor.count,
                      [&](std::size_t i) { return numbers + i * dimension; });
    if (accessor.sparse_count > 0) {
        const std::vector<std::uint32_t> targets = sparse_targets(accessor);
        load_elements(accessor, accessor.sparse_values.data(),
                      dimension * size_of(accessor.component), targets.size(),
                      [&](std::size_t i) { return numbers + targets[i] * dimension; });
    }
}

template <class Vector>
std::vector<Vector> load_vectors(const GltfAccessor& accessor)
{
    static_assert(sizeof(Vector) == Vector::length() * sizeof(double));
    SURFELAO_CHECK(accessor.dimension == Vector::length());
    std::vector<Vector> vectors(accessor.count, Vector(0.0));
    if (!vectors.empty())
        load_all(accessor, &vectors.front().x);
    return vectors;
}

void check_finite(const GltfAccessor& accessor, const double* numbers)
{
    const auto dimension = static_cast<std::size_t>(accessor.dimension);
    for (std::size_t i = 0; i < accessor.count; ++i) {
        // doubles that were floats cannot overflow: the sum is finite when all of them are
        double sum = 0.0;
        for (std::size_t k = 0; k < dimension; ++k)
            sum += numbers[i * dimension + k];
        if (!std::isfinite(sum))
            throw AccessorError("element " + std::to_string(i) + " is not finite");
    }
}

}  // namespace

std::size_t size_of(GltfComponent component)
{
    std::size_t size = 0;
    with_type(component, [&](auto value) { size = sizeof value; });
    return size;
}

bool is_index_type(GltfComponent component)
{
    return component == GltfComponent::uint8 || component == GltfComponent::uint16 ||
           component == GltfComponent::uint32;
}

std::uint32_t largest_index(GltfComponent component)
{
    SURFELAO_CHECK(is_index_type(component));
    return std::numeric_limits<std::uint32_t>::max() >> (32 - 8 * size_of(component));
}

std::vector<double> read_numbers(const GltfAccessor& accessor)
{
    std::vector<double> numbers(accessor.count * static_cast<std::size_t>(accessor.dimension), 0.0);
    load_all(accessor, numbers.data());
    check_finite(accessor, numbers.data());
    return numbers;
}

std::string read_elements(const GltfAccessor& accessor)
{
    const std::size_t size = accessor.element_bytes;
    std::string bytes(accessor.count * size, '\0');
    for (std::size_t i = 0; i < accessor.count && !accessor.zero; ++i)
        accessor.bytes.copy(bytes.data() + i * size, size, i * accessor.stride);
    if (accessor.sparse_count > 0) {
        const std::vector<std::uint32_t> targets = sparse_targets(accessor);
        for (std::size_t i = 0; i < targets.size(); ++i)
            accessor.sparse_values.copy(bytes.data() + targets[i] * size, size, i * size);
    }
    return bytes;
}

std::vector<glm::dvec3> read_vectors(const GltfAccessor& accessor)
{
    return load_vectors<glm::dvec3>(accessor);
}

std::vector<glm::dvec2> read_pairs(const GltfAccessor& accessor)
{
    return load_vectors<glm::dvec2>(accessor);
}

std::vector<glm::dvec4> read_quadruples(const GltfAccessor& accessor)
{
    return load_vectors<glm::dvec4>(accessor);
}

std::vector<glm::dvec4> read_colors(const GltfAccessor& accessor)
{
    const std::vector<double> numbers = read_numbers(accessor);
    const auto dimension = static_cast<std::size_t>(accessor.dimension);
    std::vector<glm::dvec4> colors;
    colors.reserve(accessor.count);
    for (std::size_t i = 0; i < numbers.size(); i += dimension)
        colors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2],
                            dimension == 4 ? numbers[i + 3] : 1.0);
    return colors;
}

std::vector<std::uint32_t> read_indices(const GltfAccessor& accessor)
{
    SURFELAO_CHECK(accessor.dimension == 1);
    std::vector<std::uint32_t> indices(accessor.count, 0);
    with_type(accessor.component, [&](auto sample) {
        using T = decltype(sample);
        if constexpr (std::is_unsigned_v<T>) {
            if (!accessor.zero) {
                for (std::size_t i = 0; i < accessor.count; ++i)
                    indices[i] = load<T>(accessor.bytes.data() + i * accessor.stride);
            }
            if (accessor.sparse_count > 0) {
                const std::vector<std::uint32_t> targets = sparse_targets(accessor);
                for (std::size_t i = 0; i < targets.size(); ++i)
                    indices[targets[i]] = load<T>(accessor.sparse_values.data() + i * sizeof(T));
            }
        } else {
            SURFELAO_CHECK(!"indices are unsigned");
        }
    });
    return indices;
}

}  // namespace surfelao
