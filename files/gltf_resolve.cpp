#include "files/gltf_resolve.h"

#include "files/gltf_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace surfelao {
namespace {

using nlohmann::json;

/// A whole number, which may be written as 3.0; 0 where there is none.
std::size_t number(const json& object, const char* key)
{
    return static_cast<std::size_t>(object.value(key, 0.0));
}

/// The components of an element, and the bytes: columns of matrices begin at whole words.
void set_element(GltfAccessor& accessor, const std::string& type)
{
    const auto rows = static_cast<std::size_t>(type == "SCALAR" ? 1 : type.back() - '0');
    const bool is_matrix = type.starts_with("MAT");
    const std::size_t column = rows * size_of(accessor.component);
    accessor.dimension = static_cast<int>(is_matrix ? rows * rows : rows);
    accessor.element_bytes = is_matrix ? (column + 3) / 4 * 4 * rows : column;
}

}  // namespace

std::string numbered(const char* what, std::size_t index)
{
    return std::string(what) + ' ' + std::to_string(index);
}

NamedAccessor AccessorResolver::resolve(int index, const std::string& user) const
{
    const auto accessor_index = static_cast<std::size_t>(index);
    const json& source = (*asset_.document)["accessors"][accessor_index];
    NamedAccessor named{user + numbered(" accessor", accessor_index), {}};
    GltfAccessor& accessor = named.accessor;
    accessor.count = number(source, "count");
    accessor.component = static_cast<GltfComponent>(number(source, "componentType"));
    set_element(accessor, source["type"].get_ref<const std::string&>());
    accessor.normalized = source.value("normalized", false);
    accessor.stride = accessor.element_bytes;
    accessor.zero = !source.contains("bufferView");

    const json& sparse = member(source, "sparse");
    if (!accessor.zero) {
        const std::size_t view = number(source, "bufferView");
        accessor.stride = stride_of(view, accessor, named.element);
        accessor.bytes = slice(view, number(source, "byteOffset"), accessor, named.element);
    } else if (sparse.is_null() && accessor.count > 0) {
        fail(named.element, "has neither a bufferView nor sparse values");
    }
    if (!sparse.is_null())
        resolve_sparse(sparse, named);
    return named;
}

void AccessorResolver::resolve_sparse(const json& sparse, NamedAccessor& named) const
{
    GltfAccessor& accessor = named.accessor;
    accessor.sparse_count = number(sparse, "count");
    const json& places = sparse["indices"];
    accessor.sparse_component = static_cast<GltfComponent>(number(places, "componentType"));
    if (!is_index_type(accessor.sparse_component))
        fail(named.element + " sparse indices", "are not of an unsigned integer type");

    GltfAccessor indices;
    indices.component = accessor.sparse_component;
    indices.count = accessor.sparse_count;
    indices.stride = indices.element_bytes = size_of(indices.component);
    accessor.sparse_indices = slice(number(places, "bufferView"), number(places, "byteOffset"),
                                    indices, named.element + " sparse indices");
    GltfAccessor values = accessor;
    values.count = accessor.sparse_count;
    values.stride = values.element_bytes;
    accessor.sparse_values =
        slice(number(sparse["values"], "bufferView"), number(sparse["values"], "byteOffset"),
              values, named.element + " sparse values");
}

/// The view's byteStride, or that of elements close together where it has none or zero.
std::size_t AccessorResolver::stride_of(std::size_t view, const GltfAccessor& accessor,
                                        const std::string& element) const
{
    const std::size_t stride = number((*asset_.document)["bufferViews"][view], "byteStride");
    const std::size_t size = accessor.element_bytes;
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
    const json& view = (*asset_.document)["bufferViews"][index];
    const std::size_t begin = number(view, "byteOffset"), stated = number(view, "byteLength");
    const std::string_view buffer = asset_.buffers[number(view, "buffer")].bytes;
    // the last view may count padding that its buffer does not have
    if (begin > buffer.size() || stated >= buffer.size() - begin + kMostPadding)
        fail(element + ":", numbered("bufferView", index) + " ends at byte " +
                                std::to_string(begin + stated) + ", but " +
                                numbered("buffer", number(view, "buffer")) + " has " +
                                std::to_string(buffer.size()));
    const std::size_t length = std::min(stated, buffer.size() - begin);
    // count elements end at offset + stride * (count - 1) + size
    const std::size_t size = layout.element_bytes;
    const bool fits =
        layout.count == 0 || (offset <= length && size <= length - offset &&
                              layout.count - 1 <= (length - offset - size) / layout.stride);
    if (!fits)
        fail(element + ":", std::to_string(layout.count) + " elements from byte " +
                                std::to_string(offset) + " on do not fit into " +
                                numbered("bufferView", index) + " of " + std::to_string(length) +
                                " bytes");
    return layout.count == 0 ? std::string_view() : buffer.substr(begin + offset);
}

void AccessorResolver::check_count(const NamedAccessor& named, std::size_t count,
                                   const char* what) const
{
    if (named.accessor.count != count)
        fail(named.element, "has " + std::to_string(named.accessor.count) + " elements for " +
                                std::to_string(count) + ' ' + what);
}

}  // namespace surfelao
