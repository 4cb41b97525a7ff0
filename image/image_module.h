/// image_module.h: what the module with OpenImageIO in it offers to image_file.cpp, which alone
/// opens it. Both come from one build, so C++ types may cross; exceptions do not.
#pragma once

#include "image/image.h"
#include "image/map.h"

#include <string>
#include <string_view>

namespace surfelao {

struct ImageModule {
    /// Reads `path` into `image`; returns what went wrong, without the path, or an empty string.
    std::string (*read)(const std::string& path, Image& image);
    /// The same from the contents of a file.
    std::string (*read_bytes)(std::string_view bytes, Image& image);
    /// Writes `image` to `path` in the format of its extension, with or without alpha; returns the
    /// same.
    std::string (*write)(const std::string& path, const Image& image, bool alpha);
    /// The same for a map: its numbers as they are, and a description where it is not empty.
    std::string (*write_map)(const std::string& path, const Map& map, MapDepth depth,
                             const std::string& description);
    /// Reads the numbers of `path` as they are; returns what went wrong.
    std::string (*read_map)(const std::string& path, Map& map);
    /// What stands in the file's head as its description; returns what went wrong.
    std::string (*read_description)(const std::string& path, std::string& description);
    /// The same as the contents of a .png, into `bytes`.
    std::string (*map_bytes)(const Map& map, MapDepth depth, std::string& bytes);
};

/// The name and type of the one function that the module exports.
inline constexpr const char* kImageModuleEntry = "surfelao_image_module";
using ImageModuleEntry = const ImageModule* (*)();

}  // namespace surfelao
