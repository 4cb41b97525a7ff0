/// ply_text.h: lines and numbers of a PLY as its writers put them together. Internal to
/// ply_writer.cpp and ply_new.cpp.
#pragma once

#include "files/ply_file.h"

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace surfelao::ply {

/// `property float x` and so on.
template <class Properties>
void append_property_lines(std::string& text, const Properties& properties,
                           std::string_view newline)
{
    for (const auto& property : properties)
        text.append("property ").append(property).append(newline);
}

/// `comment MARK`; nothing without one.
void append_mark_line(std::string& text, std::string_view mark, std::string_view newline);

/// `comment TextureFile NAME`; nothing without one.
void append_texture_line(std::string& text, std::string_view texture, std::string_view newline);

/// How numbers stand in the rows of a file.
struct Notation {
    bool ascii = false;
    std::endian endian = std::endian::little;
};
[[nodiscard]] Notation notation_of(const Header& header);

/// A number of this type; integers are rounded.
void append_channel(std::string& text, Type type, double value, Notation notation);

/// The same, in ascii with a blank before it.
void append_number(std::string& text, Type type, double value, Notation notation);

/// The list of a triangle's texture coordinates.
inline constexpr const char* kPlacesProperty = "list uchar float texcoord";
void append_places(std::string& text, const UvSet& uvs, std::span<const std::uint32_t> places,
                   Notation notation);

}  // namespace surfelao::ply
