/// gltf_uri.h: the URIs of buffers and images. For the glTF reader and writer; reports embed their
/// pictures by make_data_uri() too.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace surfelao {

/// The file that a relative URI names, seen from `folder`; nothing for a URI that is absolute, has
/// a scheme (data: as well), or is not well formed. Backslashes are taken as slashes.
[[nodiscard]] std::optional<std::filesystem::path> locate_uri(const std::filesystem::path& folder,
                                                              std::string_view uri);

/// The same for a file whose contents are taken: nothing, too, for one that climbs out of the
/// folder by "..". A model of a stranger shall not carry off what lies beside it.
[[nodiscard]] std::optional<std::filesystem::path> resolve_uri(const std::filesystem::path& folder,
                                                               std::string_view uri);

/// The same for a buffer, which may be a .bin anywhere: results have those of their originals.
[[nodiscard]] std::optional<std::filesystem::path> resolve_buffer_uri(
    const std::filesystem::path& folder, std::string_view uri);

/// A relative path, with slashes, as a URI: percent signs for all but ASCII letters, digits and
/// what else a path may have.
[[nodiscard]] std::string encode_uri(std::string_view path);

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a data URI of any media type, in base64 (blanks and percent signs in it are well)
/// or as they are; nothing when it is broken.
[[nodiscard]] std::optional<std::string> decode_data_uri(std::string_view uri);

[[nodiscard]] std::string make_data_uri(std::string_view media_type, std::string_view bytes);

}  // namespace surfelao
