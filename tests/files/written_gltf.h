/// written_gltf.h: what the glTF writer has written, looked at without the reader.
#pragma once

#include "gltf_maker.h"

#include "files/gltf_io.h"
#include "files/gltf_uri.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace surfelao::test {

/// Written bytes taken apart: an independent way to look at them.
struct Written {
    nlohmann::json document;
    std::string bin;  ///< of a .glb, or of the last buffer's data URI

    /// An accessor of floats, or of normalised shorts.
    std::vector<float> floats(const nlohmann::json& attribute) const
    {
        const nlohmann::json& accessor = document["accessors"][attribute.get<std::size_t>()];
        const nlohmann::json& view =
            document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::string type = accessor["type"];
        const std::size_t dimension = type == "SCALAR" ? 1 : std::size_t(type[3] - '0');
        const bool shorts = accessor["componentType"] == 5123;
        EXPECT_EQ(shorts, accessor.value("normalized", false));
        std::vector<float> values(accessor["count"].get<std::size_t>() * dimension);
        std::size_t at =
            view["byteOffset"].get<std::size_t>() + accessor["byteOffset"].get<std::size_t>();
        EXPECT_EQ(view["byteStride"], dimension * (shorts ? 2 : 4));
        EXPECT_LE(at + values.size() * (shorts ? 2 : 4), bin.size());
        for (float& value : values) {
            std::uint16_t share = 0;
            if (shorts)
                std::memcpy(&share, bin.data() + at, sizeof share);
            else
                std::memcpy(&value, bin.data() + at, sizeof value);
            value = shorts ? static_cast<float>(share) / 65535.0f : value;
            at += shorts ? 2 : 4;
        }
        return values;
    }

    const nlohmann::json& attributes(std::size_t mesh, std::size_t primitive = 0) const
    {
        return document["meshes"][mesh]["primitives"][primitive]["attributes"];
    }
};

inline std::uint32_t number_at(const std::string& bytes, std::size_t offset)
{
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

inline Written take_apart(const std::string& bytes)
{
    Written written;
    if (!bytes.starts_with("glTF")) {
        written.document = nlohmann::json::parse(bytes);
        const std::string& uri = written.document["buffers"].back()["uri"].get_ref<std::string&>();
        written.bin = decode_data_uri(uri).value_or("");
        return written;
    }
    EXPECT_EQ(number_at(bytes, 8), bytes.size());
    const std::size_t text_size = number_at(bytes, 12);
    EXPECT_EQ(text_size % 4, 0u);
    written.document = nlohmann::json::parse(bytes.substr(20, text_size));
    const std::size_t bin_size = number_at(bytes, 20 + text_size);
    EXPECT_EQ(bin_size % 4, 0u);
    written.bin = bytes.substr(28 + text_size, bin_size);
    return written;
}

/// A different value at each vertex: 0, 0.25, 0.5, 0.75, 0, ...; bent normals up.
inline std::vector<Occlusion> pattern(const Scene& scene)
{
    std::vector<Occlusion> occlusion(scene.positions.size());
    for (std::size_t i = 0; i < occlusion.size(); ++i)
        occlusion[i] = {static_cast<float>(i % 4) * 0.25f, {0, 0, 1}};
    return occlusion;
}

/// Read and written again as .glb, with the pattern.
inline Written round_trip(const GltfMaker& maker, const WriteOptions& options = {})
{
    const Scene scene = read_gltf("in.glb", maker.glb());
    return take_apart(gltf_contents("out.glb", scene, pattern(scene), options).contents);
}

}  // namespace surfelao::test
