/// gltf_maker.h: small glTF files made in code, right ones and broken ones.
#pragma once

#include "files/gltf_io.h"
#include "surfels/errors.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace surfelao::test {

template <typename T>
std::string bytes_of(std::initializer_list<T> values)
{
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.begin(), bytes.size());
    return bytes;
}

template <typename T>
constexpr int component_type()
{
    return std::is_same_v<T, std::int8_t>     ? 5120
           : std::is_same_v<T, std::uint8_t>  ? 5121
           : std::is_same_v<T, std::int16_t>  ? 5122
           : std::is_same_v<T, std::uint16_t> ? 5123
           : std::is_same_v<T, std::uint32_t> ? 5125
                                              : 5126;
}

/// A document and its binary chunk. Starts with asset, one scene that lists node 0, and buffer 0.
struct GltfMaker {
    nlohmann::json document = {{"asset", {{"version", "2.0"}}},
                               {"scene", 0},
                               {"scenes", {{{"nodes", {0}}}}},
                               {"buffers", {{{"byteLength", 0}}}}};
    std::string bin;

    /// Returns the index of the new buffer view.
    int add_view(std::string_view bytes, int stride = 0)
    {
        nlohmann::json view = {
            {"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
        if (stride != 0)
            view["byteStride"] = stride;
        bin += bytes;
        bin.resize((bin.size() + 3) / 4 * 4);
        document["buffers"][0]["byteLength"] = bin.size();
        return add("bufferViews", view);
    }

    int add_accessor(int view, int component, const char* type, std::size_t count)
    {
        return add(
            "accessors",
            {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}});
    }

    template <typename T>
    int add_vectors(std::initializer_list<T> values)
    {
        return add_accessor(add_view(bytes_of(values)), component_type<T>(), "VEC3",
                            values.size() / 3);
    }

    template <typename T>
    int add_indices(std::initializer_list<T> values)
    {
        return add_accessor(add_view(bytes_of(values)), component_type<T>(), "SCALAR",
                            values.size());
    }

    /// Appends to a top-level array and returns the new entry's index.
    int add(const char* section, const nlohmann::json& entry)
    {
        document[section].push_back(entry);
        return static_cast<int>(document[section].size()) - 1;
    }

    /// GLB: header, JSON chunk, BIN chunk where there are bytes.
    std::string glb() const
    {
        const auto number = [](std::size_t value) {
            return bytes_of({static_cast<std::uint32_t>(value)});
        };
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string chunks = number(text.size()) + "JSON" + text;
        if (!bin.empty())
            chunks += number(bin.size()) + std::string("BIN\0", 4) + bin;
        return "glTF" + number(2) + number(12 + chunks.size()) + chunks;
    }

    /// The document as text, with `uri` for its buffer.
    std::string gltf(const std::string& uri) const
    {
        nlohmann::json with_uri = document;
        with_uri["buffers"][0]["uri"] = uri;
        return with_uri.dump();
    }
};

/// The first one.
inline nlohmann::json& primitive(GltfMaker& maker)
{
    return maker.document["meshes"][0]["primitives"][0];
}

inline const nlohmann::json& primitive(const GltfMaker& maker)
{
    return maker.document["meshes"][0]["primitives"][0];
}

/// The 36 bytes of one_triangle(): 1.0f is 00 00 80 3F, at bytes 12 and 28.
inline constexpr const char* kTriangleUri =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

/// One triangle (0,0,0) (1,0,0) (0,1,0): accessor 0, mesh 0, node 0.
inline GltfMaker one_triangle()
{
    GltfMaker maker;
    maker.add_vectors<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    maker.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}});
    maker.add("nodes", {{"mesh", 0}});
    return maker;
}

/// The square (0,0,0) (1,0,0) (1,1,0) (0,1,0): accessors 0 and 1 (indices, uint16), mesh 0, node 0.
inline GltfMaker square()
{
    GltfMaker maker;
    maker.add_vectors<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    maker.add_indices<std::uint16_t>({0, 1, 2, 0, 2, 3});
    maker.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}});
    maker.add("nodes", {{"mesh", 0}});
    return maker;
}

/// What reading `contents` as made.glb is refused with.
inline std::string refusal(const std::string& contents)
{
    try {
        static_cast<void>(read_gltf("made.glb", contents));
    } catch (const InputError& error) {
        const std::string what = error.what();
        return what.starts_with("made.glb: ") ? what.substr(10) : what;
    }
    return "was read";
}

/// A row of a table of broken files.
struct Malformed {
    const char* name;
    const char* sentence;        ///< behind "made.glb: "
    void (*damage)(GltfMaker&);  ///< breaks a good file
};

inline void PrintTo(const Malformed& malformed, std::ostream* stream)
{
    *stream << malformed.name;
}

}  // namespace surfelao::test
