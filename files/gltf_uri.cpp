#include "files/gltf_uri.h"

#include "surfels/extension.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

bool is_blank_in_uri(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::optional<std::string> decode_base64(std::string_view text)
{
    static constexpr std::array<std::int8_t, 256> kValues = [] {
        std::array<std::int8_t, 256> values{};
        values.fill(-1);
        for (std::size_t i = 0; i < kBase64.size(); ++i)
            values[static_cast<unsigned char>(kBase64[i])] = static_cast<std::int8_t>(i);
        return values;
    }();
    text.remove_suffix(text.size() - (text.find_last_not_of("= \t\r\n") + 1));
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t pending = 0;
    int bits = 0;
    for (const char c : text) {
        if (is_blank_in_uri(c))
            continue;
        const int value = kValues[static_cast<unsigned char>(c)];
        if (value < 0)
            return std::nullopt;
        pending = pending << 6 | static_cast<std::uint32_t>(value);
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes.push_back(static_cast<char>(pending >> bits & 0xFF));
        }
    }
    if (bits == 6)  // a letter alone is less than a byte
        return std::nullopt;
    return bytes;
}

int hex_value(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

/// A '%' without two digits behind it is one that somebody forgot to encode.
std::string decode_percent(std::string_view uri)
{
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = i + 1 < uri.size() ? hex_value(uri[i + 1]) : -1;
        const int low = i + 2 < uri.size() ? hex_value(uri[i + 2]) : -1;
        if (uri[i] != '%' || high < 0 || low < 0) {
            decoded.push_back(uri[i]);
            continue;
        }
        decoded.push_back(static_cast<char>(high * 16 + low));
        i += 2;
    }
    return decoded;
}

/// What a relative URI says, with the slashes of this system.
std::optional<fs::path> path_of(std::string_view uri)
{
    std::string name = decode_percent(uri);
    if (name.empty() || std::ranges::any_of(name, [](unsigned char c) { return std::iscntrl(c); }))
        return std::nullopt;
    std::ranges::replace(name, '\\', '/');
    // a colon in front of the first slash ends a scheme or a drive
    if (name.substr(0, name.find('/')).find(':') != name.npos)
        return std::nullopt;
    const fs::path relative(name);
    return relative.is_absolute() ? std::nullopt : std::optional(relative);
}

/// Characters of a path that stand in a URI as they are, beside letters and digits.
constexpr std::string_view kUnescaped = "/-._~!$&'()*+,;=@";

}  // namespace

std::optional<fs::path> locate_uri(const fs::path& folder, std::string_view uri)
{
    const std::optional<fs::path> path = path_of(uri);
    return path ? std::optional(folder / *path) : std::nullopt;
}

std::optional<fs::path> resolve_uri(const fs::path& folder, std::string_view uri)
{
    const std::optional<fs::path> path = path_of(uri);
    if (!path || std::find(path->begin(), path->end(), fs::path("..")) != path->end())
        return std::nullopt;
    return folder / *path;
}

std::optional<fs::path> resolve_buffer_uri(const fs::path& folder, std::string_view uri)
{
    std::optional<fs::path> file = locate_uri(folder, uri);
    return file && lower_extension(*file) == ".bin" ? file : resolve_uri(folder, uri);
}

std::string encode_uri(std::string_view path)
{
    std::string uri;
    for (const unsigned char c : path) {
        if (std::isalnum(c) || kUnescaped.find(static_cast<char>(c)) != kUnescaped.npos) {
            uri.push_back(static_cast<char>(c));
            continue;
        }
        uri.push_back('%');
        for (const int digit : {c >> 4, c & 15})
            uri.push_back("0123456789ABCDEF"[digit]);
    }
    return uri;
}

bool is_data_uri(std::string_view uri)
{
    return uri.starts_with("data:");
}

std::optional<std::string> decode_data_uri(std::string_view uri)
{
    const std::size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == uri.npos)
        return std::nullopt;
    const std::string bytes = decode_percent(uri.substr(comma + 1));
    std::string how(uri.substr(0, comma));
    std::ranges::transform(how, how.begin(), [](unsigned char c) { return std::tolower(c); });
    return how.ends_with("base64") ? decode_base64(bytes) : bytes;
}

std::string make_data_uri(std::string_view media_type, std::string_view bytes)
{
    std::string uri = "data:";
    uri.append(media_type).append(";base64,");
    uri.reserve(uri.size() + (bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group =
                group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            uri.push_back(i + k <= bytes.size() ? kBase64[group >> (18 - 6 * k) & 63] : '=');
    }
    return uri;
}

}  // namespace surfelao
