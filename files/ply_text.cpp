#include "files/ply_text.h"

#include "files/ply_io.h"
#include "files/sidecars.h"
#include "surfels/number_text.h"

#include <cmath>

namespace surfelao::ply {

void append_mark_line(std::string& text, std::string_view mark, std::string_view newline)
{
    if (!mark.empty())
        text.append("comment ").append(mark).append(newline);
}

void append_texture_line(std::string& text, std::string_view texture, std::string_view newline)
{
    if (!texture.empty())
        text.append("comment ").append(kTextureKeyword).append(" ").append(texture).append(newline);
}

Notation notation_of(const Header& header)
{
    return {header.format == Format::ascii,
            header.format == Format::big_endian ? std::endian::big : std::endian::little};
}

void append_channel(std::string& text, Type type, double value, Notation notation)
{
    const std::int64_t whole = std::llround(value);
    if (notation.ascii) {
        if (is_integer(type))
            append_integer(text, whole);
        else
            append_shortest(text, static_cast<float>(value));
    } else if (type == Type::float32) {
        append_bytes(text, static_cast<float>(value), notation.endian);
    } else if (type == Type::float64) {
        append_bytes(text, value, notation.endian);
    } else if (size_of(type) == 1) {
        append_bytes(text, static_cast<std::uint8_t>(whole), notation.endian);
    } else if (size_of(type) == 2) {
        append_bytes(text, static_cast<std::uint16_t>(whole), notation.endian);
    } else {
        append_bytes(text, static_cast<std::uint32_t>(whole), notation.endian);
    }
}

void append_number(std::string& text, Type type, double value, Notation notation)
{
    append_channel(notation.ascii ? text += ' ' : text, type, value, notation);
}

void append_places(std::string& text, const UvSet& uvs, std::span<const std::uint32_t> places,
                   Notation notation)
{
    append_number(text, Type::uint8, static_cast<double>(2 * places.size()), notation);
    for (const std::uint32_t place : places) {
        append_number(text, Type::float32, uvs.values[place].x, notation);
        append_number(text, Type::float32, 1.0 - uvs.values[place].y, notation);  // v runs up
    }
}

}  // namespace surfelao::ply
