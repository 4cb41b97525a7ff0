#include "files/ply_text.h"

#include "files/sidecars.h"

#include <algorithm>

namespace surfelao::ply {

void append_property_lines(std::string& text, std::span<const std::string> properties,
                           std::string_view newline)
{
    for (const std::string& property : properties)
        text.append("property ").append(property).append(newline);
}

std::vector<std::string> property_words(std::span<const Column> columns)
{
    std::vector<std::string> words;
    for (const Column& column : columns) {
        words.push_back(std::string(name_of(column.type)) + " " + column.name);
        std::ranges::replace(
            words.back().begin() + static_cast<std::ptrdiff_t>(name_of(column.type).size()) + 1,
            words.back().end(), ' ', '_');
    }
    return words;
}

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
