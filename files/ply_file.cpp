#include "files/ply_file.h"

#include <set>

namespace surfelao::ply {
namespace {

Type read_type(TextCursor& cursor)
{
    const std::string_view word = cursor.word();
    const std::optional<Type> type = type_named(word);
    if (!type)
        cursor.fail(quoted(word) + " is not a type");
    return *type;
}

/// Names of what was declared so far; views into the file.
using Names = std::set<std::string_view>;

/// Of properties that make the shape: two of a name would leave it in doubt.
constexpr std::string_view kGeometryNames[] = {"x", "y", "z", "vertex_indices", "vertex_index"};

Property read_property(TextCursor& cursor, const Element& element, Names& names)
{
    Property property;
    TextCursor ahead = cursor;
    if (ahead.word() == "list") {
        cursor = ahead;
        property.count_type = read_type(cursor);
        if (!is_integer(*property.count_type))
            cursor.fail("the length of a list must have an integer type");
    }
    property.type = read_type(cursor);
    const std::string_view name = cursor.word();
    if (name.empty())
        cursor.fail("the property has no name");
    property.is_second = !names.insert(name).second;
    if (property.is_second && std::ranges::find(kGeometryNames, name) != std::end(kGeometryNames))
        cursor.fail("element " + surfelao::quoted(element.name) + " has two properties " +
                    quoted(name));
    property.name = name;
    return property;
}

Element read_element(TextCursor& cursor, Names& names)
{
    const std::string_view name = cursor.word();
    if (name.empty())
        cursor.fail("the element has no name");
    if (!names.insert(name).second)
        cursor.fail("a second element " + quoted(name));
    Element element;
    element.name = name;
    const std::int64_t count = cursor.integer("the count of the element");
    if (count < 0)
        cursor.fail("element " + surfelao::quoted(element.name) + " has the negative count " +
                    std::to_string(count));
    element.count = static_cast<std::uint64_t>(count);
    return element;
}

Format read_format(TextCursor& cursor)
{
    const std::string_view format = cursor.word();
    const std::string_view version = cursor.word();
    if (version != "1.0")
        cursor.fail("version " + quoted(version) + " is not known, only 1.0");
    if (format == "ascii")
        return Format::ascii;
    if (format == "binary_little_endian")
        return Format::little_endian;
    if (format == "binary_big_endian")
        return Format::big_endian;
    cursor.fail("format " + quoted(format) + " is not known");
}

/// Of a comment `viewpoint X Y Z`; none for any other.
std::optional<glm::dvec3> read_viewpoint(TextCursor& cursor)
{
    if (cursor.word() != "viewpoint")
        return std::nullopt;
    glm::dvec3 place;
    for (int axis = 0; axis < 3; ++axis)
        place[axis] = number_in(cursor.word()).value_or(std::numeric_limits<double>::quiet_NaN());
    return cursor.at_line_end() ? as_viewpoint(place) : std::nullopt;
}

/// The end of a line that stands at this byte.
std::string newline_at(std::string_view contents, std::size_t offset)
{
    const std::string_view rest = contents.substr(offset, 2);
    if (rest == "\r\n")
        return "\r\n";
    return std::string(rest.substr(0, 1));
}

}  // namespace

std::size_t line_after(std::string_view contents, std::size_t offset)
{
    return offset + newline_at(contents, offset).size();
}

const Element* find_element(const Header& header, std::string_view name)
{
    const auto found = std::ranges::find(header.elements, name, &Element::name);
    return found == header.elements.end() ? nullptr : &*found;
}

std::size_t index_list_of(const Element& element)
{
    const auto found = std::ranges::find_if(element.properties, [](const Property& property) {
        return property.name == "vertex_indices" || property.name == "vertex_index";
    });
    return static_cast<std::size_t>(found - element.properties.begin());
}

Header read_header(const std::string& file_name, std::string_view contents)
{
    Header header;
    TextCursor cursor(file_name, contents, {});
    if (!cursor.next_line() || cursor.word() != "ply" || !cursor.at_line_end())
        throw InputError(file_name + ": does not begin with the line \"ply\"");
    header.newline = newline_at(contents, cursor.offset());
    bool has_format = false;
    Names elements;
    Names properties;  // of the last element
    while (true) {
        if (!cursor.next_line())
            throw InputError(file_name + ": ends within the header (no line \"end_header\")");
        const std::string_view keyword = cursor.word();
        if (keyword == "end_header")
            break;
        // Blender 2.47 forgot the word "comment" before its "Created by"
        if (keyword == "comment" || keyword == "obj_info" || keyword == "Created") {
            if (keyword == "comment" && !header.viewpoint)
                header.viewpoint = read_viewpoint(cursor);
            continue;
        }
        if (keyword == "format") {
            if (has_format)
                cursor.fail("a second line \"format\"");
            header.format = read_format(cursor);
            has_format = true;
        } else if (keyword == "element") {
            header.elements.push_back(read_element(cursor, elements));
            properties.clear();
        } else if (keyword == "property") {
            if (header.elements.empty())
                cursor.fail("a property before the first element");
            Element& element = header.elements.back();
            element.properties.push_back(read_property(cursor, element, properties));
        } else {
            cursor.fail(quoted(keyword) + " is not a word of a PLY header");
        }
        if (!cursor.at_line_end())
            cursor.fail(quoted(cursor.word()) + " stands behind the end of the statement");
        if (!header.elements.empty())
            header.elements.back().lines_end = line_after(contents, cursor.offset());
    }
    if (!has_format)
        throw InputError(file_name + ": the header has no line \"format\"");
    if (!cursor.at_line_end())
        cursor.fail(quoted(cursor.word()) + " stands behind \"end_header\"");
    header.line_count = cursor.line();
    header.data_begin = line_after(contents, cursor.offset());
    // with CR alone as the end of lines, a following LF is the first byte of binary data
    if (header.newline == "\r")
        header.data_begin = std::min(header.data_begin, cursor.offset() + 1);
    return header;
}

}  // namespace surfelao::ply
