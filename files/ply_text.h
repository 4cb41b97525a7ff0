/// ply_text.h: lines and numbers of a PLY as its writers put them together. Internal to
/// ply_writer.cpp and ply_new.cpp.
#pragma once

#include "files/ply_file.h"
#include "files/vertex_rows.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao::ply {

/// `property float x` and so on.
void append_property_lines(std::string& text, std::span<const std::string> properties,
                           std::string_view newline);

/// "float x"
[[nodiscard]] std::vector<std::string> property_words(std::span<const Column> columns);

/// `comment MARK`; nothing without one.
void append_mark_line(std::string& text, std::string_view mark, std::string_view newline);

/// `comment TextureFile NAME`; nothing without one.
void append_texture_line(std::string& text, std::string_view texture, std::string_view newline);

/// The list of a triangle's texture coordinates.
inline constexpr const char* kPlacesProperty = "list uchar float texcoord";
void append_places(std::string& text, const UvSet& uvs, std::span<const std::uint32_t> places,
                   Notation notation);

}  // namespace surfelao::ply
