#include "surfels/gltf_accessor.h"

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

template <typename T>
glm::dvec3 load_vector(const char* at, bool normalized)
{
    return {to_real(load<T>(at), normalized), to_real(load<T>(at + sizeof(T)), normalized),
            to_real(load<T>(at + 2 * sizeof(T)), normalized)};
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

}  // namespace

std::size_t size_of(GltfComponent component)
{
    std::size_t size = 0;
    with_type(component, [&](auto value) { size = sizeof value; });
    return size;
}

void append_vectors(const GltfAccessor& accessor, std::vector<glm::dvec3>& vectors)
{
    SURFELAO_CHECK(accessor.dimension == 3);
    const std::size_t first = vectors.size();
    vectors.resize(first + accessor.count, glm::dvec3(0.0));
    with_type(accessor.component, [&](auto sample) {
        using T = decltype(sample);
        if (!accessor.zero) {
            for (std::size_t i = 0; i < accessor.count; ++i)
                vectors[first + i] = load_vector<T>(accessor.bytes.data() + i * accessor.stride,
                                                    accessor.normalized);
        }
        if (accessor.sparse_count > 0) {
            const std::vector<std::uint32_t> targets = sparse_targets(accessor);
            for (std::size_t i = 0; i < targets.size(); ++i)
                vectors[first + targets[i]] = load_vector<T>(
                    accessor.sparse_values.data() + i * 3 * sizeof(T), accessor.normalized);
        }
    });
    for (std::size_t i = first; i < vectors.size(); ++i) {
        if (!std::isfinite(vectors[i].x + vectors[i].y + vectors[i].z))
            throw AccessorError("element " + std::to_string(i - first) + " is not finite");
    }
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
