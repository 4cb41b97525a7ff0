#include "files/gltf_resolve.h"

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace surfelao {
namespace {

std::size_t element_size(const GltfAccessor& accessor)
{
    return size_of(accessor.component) * static_cast<std::size_t>(accessor.dimension);
}

}  // namespace

std::string numbered(const char* what, std::size_t index)
{
    return std::string(what) + ' ' + std::to_string(index);
}

NamedAccessor AccessorResolver::resolve(int index, const std::string& user) const
{
    const auto accessor_index = static_cast<std::size_t>(index);
    const tinygltf::Accessor& source = model_.accessors[accessor_index];
    NamedAccessor named{user + numbered(" accessor", accessor_index), {}};
    GltfAccessor& accessor = named.accessor;
    accessor.count = source.count;
    accessor.component = static_cast<GltfComponent>(source.componentType);
    accessor.dimension = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(source.type));
    accessor.normalized = source.normalized;
    accessor.stride = element_size(accessor);
    accessor.zero = source.bufferView < 0;

    if (!accessor.zero) {
        const auto view = static_cast<std::size_t>(source.bufferView);
        accessor.stride = stride_of(view, accessor, named.element);
        accessor.bytes = slice(view, source.byteOffset, accessor, named.element);
    } else if (!source.sparse.isSparse && source.count > 0) {
        fail(named.element, "has neither a bufferView nor sparse values");
    }
    if (source.sparse.isSparse)
        resolve_sparse(index, named);
    return named;
}

void AccessorResolver::resolve_sparse(int index, NamedAccessor& named) const
{
    const auto& sparse = model_.accessors[static_cast<std::size_t>(index)].sparse;
    GltfAccessor& accessor = named.accessor;
    accessor.sparse_count = static_cast<std::size_t>(sparse.count);
    accessor.sparse_component = static_cast<GltfComponent>(sparse.indices.componentType);
    if (!is_index_type(accessor.sparse_component))
        fail(named.element + " sparse indices", "are not of an unsigned integer type");

    GltfAccessor indices;
    indices.component = accessor.sparse_component;
    indices.count = accessor.sparse_count;
    indices.stride = element_size(indices);
    accessor.sparse_indices = slice(static_cast<std::size_t>(sparse.indices.bufferView),
                                    static_cast<std::size_t>(sparse.indices.byteOffset), indices,
                                    named.element + " sparse indices");
    GltfAccessor values = accessor;
    values.count = accessor.sparse_count;
    values.stride = element_size(values);
    accessor.sparse_values = slice(static_cast<std::size_t>(sparse.values.bufferView),
                                   static_cast<std::size_t>(sparse.values.byteOffset), values,
                                   named.element + " sparse values");
}

/// The view's byteStride, or that of elements close together where it has none or zero.
std::size_t AccessorResolver::stride_of(std::size_t view, const GltfAccessor& accessor,
                                        const std::string& element) const
{
    const nlohmann::json& source = (*asset_.document)["bufferViews"][view];
    const auto stride = static_cast<std::size_t>(source.value("byteStride", 0.0));
    const std::size_t size = element_size(accessor);
    if (stride == 0)
        return size;
    if (stride < size || stride % size_of(accessor.component) != 0)
        fail(element, "has elements of " + std::to_string(size) + " bytes, but " +
                          numbered("bufferView", view) + " has a byteStride of " +
                          std::to_string(stride));
    return stride;
}

/// The bytes of a buffer view from `offset` on, which hold the elements of `layout`.
std::string_view AccessorResolver::slice(std::size_t index, std::size_t offset,
                                         const GltfAccessor& layout,
                                         const std::string& element) const
{
    const tinygltf::BufferView& view = model_.bufferViews[index];
    const std::string_view buffer = asset_.buffers[static_cast<std::size_t>(view.buffer)].bytes;
    // the last view may count padding that its buffer does not have
    if (view.byteOffset > buffer.size() ||
        view.byteLength >= buffer.size() - view.byteOffset + kMostPadding)
        fail(element + ":", numbered("bufferView", index) + " ends at byte " +
                                std::to_string(view.byteOffset + view.byteLength) + ", but " +
                                numbered("buffer", static_cast<std::size_t>(view.buffer)) +
                                " has " + std::to_string(buffer.size()));
    const std::size_t length = std::min(view.byteLength, buffer.size() - view.byteOffset);
    // count elements end at offset + stride * (count - 1) + size
    const std::size_t size = element_size(layout);
    const bool fits =
        layout.count == 0 || (offset <= length && size <= length - offset &&
                              layout.count - 1 <= (length - offset - size) / layout.stride);
    if (!fits)
        fail(element + ":", std::to_string(layout.count) + " elements from byte " +
                                std::to_string(offset) + " on do not fit into " +
                                numbered("bufferView", index) + " of " + std::to_string(length) +
                                " bytes");
    return layout.count == 0 ? std::string_view() : buffer.substr(view.byteOffset + offset);
}

void AccessorResolver::check_count(const NamedAccessor& named, std::size_t count,
                                   const char* what) const
{
    if (named.accessor.count != count)
        fail(named.element, "has " + std::to_string(named.accessor.count) + " elements for " +
                                std::to_string(count) + ' ' + what);
}

}  // namespace surfelao
