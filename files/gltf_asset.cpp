#include "files/gltf_asset.h"

#include "files/file_contents.h"
#include "files/gltf_uri.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Written files have about ten levels; recursion over the document is safe at this depth.
constexpr int kMaxNesting = 256;

/// Longest part of the file's own text in a message, in bytes.
constexpr std::size_t kMaxQuote = 80;

constexpr std::size_t kMaxParseError = 200;

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"

std::uint32_t little_endian_32(std::string_view bytes, std::size_t offset)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
    return value;
}

struct Container {
    std::string_view text;
    std::string_view bin;
    std::vector<std::string_view> other_chunks;
    std::vector<std::string> notes;
};

/// Where the chunk behind one that ends at `chunk_end` begins. Chunks are padded to a multiple of
/// four bytes; a writer may have forgotten to pad, or to count the padding.
std::size_t next_chunk(std::string_view file, std::size_t chunk_end, std::size_t file_end)
{
    if (chunk_end + 8 <= file_end && little_endian_32(file, chunk_end + 4) == kBinChunk)
        return chunk_end;
    return std::min((chunk_end + 3) / 4 * 4, file_end);
}

Container open_glb(std::string_view file, const fs::path& path)
{
    if (file.size() < 12)
        fail_gltf(path, "GLB header",
                  "has " + std::to_string(file.size()) + " bytes instead of 12");
    const std::uint32_t version = little_endian_32(file, 4);
    if (version != 2)
        fail_gltf(path, "GLB header",
                  "has version " + std::to_string(version) + ", only 2 is read");
    const std::size_t declared = little_endian_32(file, 8);
    std::size_t end = declared < 12 || declared > file.size() ? file.size() : declared;
    Container container;
    bool has_text = false;
    bool has_bin = false;
    std::size_t unpadded = 0;
    std::size_t at = 12;
    for (int chunk = 0; at + 8 <= end; ++chunk) {
        const std::size_t size = little_endian_32(file, at);
        const std::uint32_t type = little_endian_32(file, at + 4);
        at += 8;
        if (size > file.size() - at)
            fail_gltf(path, "GLB chunk " + std::to_string(chunk),
                      "declares " + std::to_string(size) + " bytes, but only " +
                          std::to_string(file.size() - at) + " follow");
        if (size > end - at)  // the chunk is there, so what the header says is wrong
            end = file.size();
        const std::string_view contents = file.substr(at, size);
        if (chunk == 0 && type != kJsonChunk)
            fail_gltf(path, "GLB chunk 0", "is not of type JSON");
        if (chunk == 0) {
            container.text = contents;
            has_text = true;
        } else if (type == kBinChunk && !has_bin) {
            container.bin = contents;
            has_bin = true;
        } else {
            container.other_chunks.push_back(file.substr(at - 8, size + 8));
        }
        unpadded += size % 4 != 0;
        at = next_chunk(file, at + size, end);
    }
    if (unpadded > 0)
        container.notes.push_back(count_text(unpadded, "chunk") +
                                  " of the GLB of a length that is no multiple of 4");
    if (end != declared)
        container.notes.push_back("the GLB's header says " + count_text(declared, "byte") +
                                  ", the file has " + std::to_string(file.size()));
    else if (end < file.size())
        container.notes.push_back(count_text(file.size() - end, "byte") +
                                  " behind the end of the GLB passed over");
    if (!has_text)
        fail_gltf(path, "GLB", "has no JSON chunk");
    return container;
}

void check_nesting(std::string_view text, const fs::path& path)
{
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            for (++i; i < text.size() && text[i] != '"'; ++i)
                i += text[i] == '\\' ? 1 : 0;
        } else if (c == '[' || c == '{') {
            if (++depth > kMaxNesting)
                fail_gltf(path, "JSON",
                          "is nested deeper than " + std::to_string(kMaxNesting) + " levels");
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

json parse_document(std::string_view text, const fs::path& path)
{
    check_nesting(text, path);
    try {
        json document = json::parse(text);
        if (!document.is_object())
            fail_gltf(path, "JSON", "is not an object");
        return document;
    } catch (const json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: ..." with bytes of the
        // file at its end
        std::string what = error.what();
        what.erase(0, what.find("] ") + 2);
        if (what.size() > kMaxParseError)
            what.replace(kMaxParseError, what.npos, "...");
        std::ranges::replace_if(
            what, [](unsigned char c) { return c >= 0x80; }, '?');
        fail_gltf(path, "JSON:", what);
    }
}

/// A version as a string, or as the number that some write in its place; empty: neither.
std::string version_text(const json& version)
{
    if (version.is_string())
        return version.get<std::string>();
    return version.is_number() ? version.dump() : std::string();
}

void check_version(const json& document, const fs::path& path)
{
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object())
        fail_gltf(path, "asset", "is missing: this is not glTF");
    const std::string version = version_text(asset->value("version", json()));
    if (version.empty())
        fail_gltf(path, "asset", "has no version");
    if (version != "2" && !version.starts_with("2."))
        fail_gltf(path, "asset", "is glTF version " + shortened(version) + ", only 2.x is read");
    const auto minimum = asset->find("minVersion");
    if (minimum != asset->end() && version_text(*minimum) != "2" && version_text(*minimum) != "2.0")
        fail_gltf(
            path, "asset",
            "demands a reader of version " + shortened(minimum->dump()) + ", this one knows 2.0");
}

/// The contents that a buffer's uri stands for.
std::string load_uri(const std::string& uri, const fs::path& path, const std::string& element)
{
    if (is_data_uri(uri)) {
        std::optional<std::string> bytes = decode_data_uri(uri);
        if (!bytes)
            fail_gltf(path, element, "has a data URI that is broken");
        return *std::move(bytes);
    }
    const std::string place = element + " uri \"" + shortened(uri) + '"';
    const std::optional<fs::path> file = resolve_buffer_uri(path.parent_path(), uri);
    if (!file)
        fail_gltf(path, place,
                  "is not the relative path of a file in the model's own folder, or of a .bin");
    return read_contents(*file, path.string() + ": " + place);
}

void load_buffers(GltfAsset& asset)
{
    const auto section = asset.document->find("buffers");
    if (section == asset.document->end())
        return;
    if (!section->is_array())
        fail_gltf(asset.path, "buffers", "is not an array");
    asset.buffers.resize(section->size());
    std::map<std::string, std::shared_ptr<const std::string>> files;
    for (std::size_t i = 0; i < asset.buffers.size(); ++i) {
        const json& entry = (*section)[i];
        const std::string element = "buffer " + std::to_string(i);
        if (!entry.is_object())
            fail_gltf(asset.path, element, "is not an object");
        const auto length = entry.find("byteLength");
        // as a double: 36.0 is a whole number too, and no buffer comes near 2^53 bytes
        const double byte_length =
            length != entry.end() && length->is_number() ? length->get<double>() : -1.0;
        if (byte_length < 0.0 || byte_length != std::floor(byte_length))
            fail_gltf(asset.path, element, "has no byteLength that is a whole number");

        GltfBuffer& buffer = asset.buffers[i];
        const auto uri = entry.find("uri");
        if (uri != entry.end()) {
            if (!uri->is_string())
                fail_gltf(asset.path, element, "has a uri that is not a string");
            const auto& name = uri->get_ref<const std::string&>();
            std::shared_ptr<const std::string>& contents = files[name];
            if (!contents) {
                contents = std::make_shared<const std::string>(load_uri(name, asset.path, element));
                asset.byte_count += contents->size();
            }
            buffer.contents = contents;
            buffer.bytes = *buffer.contents;
        } else if (i == 0 && !asset.bin.empty()) {
            buffer.bytes = asset.bin;
        } else {
            continue;
        }
        // what is missing may be padding, which nobody reads
        if (byte_length >= static_cast<double>(buffer.bytes.size() + kMostPadding))
            fail_gltf(asset.path, element,
                      "declares " + length->dump() + " bytes, but has " +
                          std::to_string(buffer.bytes.size()));
        if (byte_length > static_cast<double>(buffer.bytes.size()))
            asset.notes.push_back(element + " lacks its last bytes, which nothing uses");
        buffer.bytes = buffer.bytes.substr(0, static_cast<std::size_t>(byte_length));
    }
}

}  // namespace

bool is_listed(std::string_view name, std::span<const std::string_view> list)
{
    return std::ranges::any_of(list, [&](std::string_view entry) {
        return entry.ends_with('_') ? name.starts_with(entry) : name == entry;
    });
}

std::string shortened(std::string_view text)
{
    std::size_t length = std::min(text.size(), kMaxQuote);
    while (length > 0 && length < text.size() && (text[length] & 0xC0) == 0x80)
        --length;
    return std::string(text.substr(0, length));
}

void fail_gltf(const fs::path& path, std::string_view element, std::string_view fault)
{
    std::string sentence(element);
    sentence.append(element.empty() ? "" : " ").append(fault);
    // names out of the file may hold anything
    std::ranges::replace_if(
        sentence, [](unsigned char c) { return std::iscntrl(c); }, '?');
    throw InputError(path.string() + ": " + sentence);
}

GltfAsset::GltfAsset() : document(std::make_unique<json>())
{
}
GltfAsset::~GltfAsset() = default;

std::size_t mesh_text_size(const GltfAsset& asset, std::size_t mesh)
{
    return (*asset.document)["meshes"][mesh].dump().size();
}

std::size_t node_text_size(const GltfAsset& asset, std::size_t node)
{
    std::size_t size = 0;
    for (const char* key : {"name", "weights"}) {
        const json& entry = (*asset.document)["nodes"][node];
        if (entry.contains(key))
            size += entry[key].dump().size();
    }
    return size;
}

void load_gltf_asset(const fs::path& path, std::string contents, GltfAsset& asset)
{
    asset.path = path;
    asset.file = std::move(contents);
    asset.byte_count = asset.file.size();
    const bool binary = asset.file.starts_with("glTF");
    Container container = binary ? open_glb(asset.file, path) : Container{asset.file, {}, {}, {}};
    const std::size_t text_size = container.text.find_last_not_of('\0') + 1;
    if (text_size < container.text.size())
        container.notes.push_back(count_text(container.text.size() - text_size, "zero byte") +
                                  " behind the JSON passed over");
    *asset.document = parse_document(container.text.substr(0, text_size), path);
    asset.bin = container.bin;
    asset.other_chunks = container.other_chunks;
    asset.notes = std::move(container.notes);
    if (!binary)
        asset.file = {};
    check_version(*asset.document, path);
    load_buffers(asset);
}

bool is_baked(const GltfTriangles& triangles, const std::vector<bool>& unbaked)
{
    if (unbaked.empty())
        return true;
    const auto begin = unbaked.begin() + std::ptrdiff_t{triangles.first};
    return std::find(begin, begin + std::ptrdiff_t{triangles.count}, false) !=
           begin + std::ptrdiff_t{triangles.count};
}

std::vector<bool> GltfAsset::baked_uses(const std::vector<bool>& unbaked) const
{
    std::vector<bool> baked(uses.size(), unbaked.empty());
    for (const GltfPart& part : parts) {
        for (const GltfTriangles& triangles : part.primitives) {
            if (is_baked(triangles, unbaked))
                baked[part.use] = true;
        }
    }
    return baked;
}

}  // namespace surfelao
