/// gltf_uri.h: the URIs of buffers and images. For the glTF reader and writer; reports embed their
/// pictures by make_data_uri() too.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace surfelao {

/// The file that a relative URI names, seen from `folder`; nothing for a URI that is absolute, has
/// a scheme (data: as well), climbs out of the folder by "..", or is not well formed.
[[nodiscard]] std::optional<std::filesystem::path> resolve_uri(const std::filesystem::path& folder,
                                                               std::string_view uri);

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a data URI of any media type, in base64 (blanks and percent signs in it are well)
/// or as they are; nothing when it is broken.
[[nodiscard]] std::optional<std::string> decode_data_uri(std::string_view uri);

[[nodiscard]] std::string make_data_uri(std::string_view media_type, std::string_view bytes);

}  // namespace surfelao
