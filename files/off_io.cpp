#include "files/off_io.h"

#include "files/off_file.h"
#include "surfels/errors.h"

#include <cmath>

namespace surfelao {
namespace {

using Header = OffHeader;

/// x y z, normal, colour, texture coordinates.
constexpr int kMostVertexNumbers = 3 + 3 + 4 + 2;

constexpr std::string_view kDigits = "0123456789";

/// The cursor stands on a line with a word left, or moves to the next.
void next_word_line(TextCursor& cursor, const std::string& wanted)
{
    if (cursor.at_line_end() && !cursor.next_line())
        cursor.fail("the file ends, but " + wanted);
}

std::uint64_t read_count(TextCursor& cursor, const std::string& what)
{
    next_word_line(cursor, "the number of " + what + " is missing");
    const std::int64_t count = cursor.integer({});
    if (count < 0)
        cursor.fail("the number of " + what + " is " + std::to_string(count));
    return static_cast<std::uint64_t>(count);
}

/// Refuses counts for which the file is too short before anything of that size is reserved.
void check_room(const TextCursor& cursor, const Header& header)
{
    const std::size_t most_vertices =
        cursor.remaining() / 6 + 1;                             // "0 0 0" and the end of the line
    const std::size_t most_faces = cursor.remaining() / 4 + 1;  // "1 0"
    if (header.vertices > most_vertices || header.faces > most_faces) {
        cursor.fail(std::to_string(header.vertices) + " vertices and " +
                    std::to_string(header.faces) +
                    " faces are more than the rest of the file can hold");
    }
}

Header read_header(const std::string& file_name, TextCursor& cursor)
{
    Header header;
    if (!cursor.next_line())
        throw InputError(file_name + ": is empty");
    TextCursor ahead = cursor;
    const std::string_view keyword = ahead.word();
    std::string_view glued;  // as in ModelNet: OFF490 518 0
    if (keyword.find_first_not_of("0123456789+-") != std::string_view::npos) {
        std::string_view prefix = keyword.substr(0, keyword.find_last_not_of(kDigits) + 1);
        if (!prefix.ends_with("OFF") && prefix != "off")
            cursor.fail("begins with " + quoted(keyword) + ", but must begin with OFF");
        glued = keyword.substr(prefix.size());
        header.keyword = prefix;
        prefix.remove_suffix(3);
        for (const std::string_view known : {"ST", "C", "N"}) {
            if (!prefix.starts_with(known))
                continue;
            prefix.remove_prefix(known.size());
            header.has_textures |= known == "ST";
            header.has_normals = known == "N";
        }
        if (!prefix.empty())
            cursor.fail("the variant " + quoted(keyword) + " is not known");
        cursor = ahead;
        ahead = cursor;
        if (!ahead.at_line_end() && ahead.word() == "BINARY")
            cursor.fail("binary OFF files are not read");
    }
    header.vertices = glued.empty() ? read_count(cursor, "vertices")
                                    : static_cast<std::uint64_t>(cursor.integer_of(glued));
    header.is_glued = !glued.empty();
    header.faces = read_count(cursor, "faces");
    // the edges, which may be missing: a line with a single number is no vertex
    ahead = cursor;
    const bool same_line = !cursor.at_line_end();
    if (same_line || (ahead.next_line() && !ahead.word().empty() && ahead.at_line_end())) {
        next_word_line(cursor, "the number of edges is missing");
        cursor.integer({});
    }
    if (!cursor.at_line_end())
        cursor.fail(quoted(cursor.word()) + " stands behind the counts");
    check_room(cursor, header);
    header.end = cursor.offset();
    return header;
}

/// Its normal and texture coordinates go into `given`, where they are as many as the vertices as
/// soon as one has any.
glm::dvec3 read_vertex(TextCursor& cursor, std::uint64_t vertex, Header& header,
                       PolygonCorners& given)
{
    if (!cursor.next_line())
        cursor.fail("the file ends, but vertex " + std::to_string(vertex) + " of " +
                    std::to_string(header.vertices) + " is missing");
    glm::dvec3 position;
    for (int axis = 0; axis < 3; ++axis) {
        if (cursor.at_line_end())
            cursor.fail("vertex " + std::to_string(vertex) + " has " + std::to_string(axis) +
                        " numbers, but needs 3");
        position[axis] = cursor.any_number({});
    }
    int numbers = 3;
    glm::vec3 normal(0.0f);
    if (header.has_normals) {
        for (; numbers < 6 && !cursor.at_line_end(); ++numbers)
            normal[numbers - 3] = static_cast<float>(cursor.any_number({}));
        if (numbers == 6) {
            given.normals.values.resize(header.vertices, glm::vec3(0.0f));
            given.normals.values[vertex] = normal;
        }
    }
    const int first = numbers;
    glm::dvec2 last(0.0);
    for (; !cursor.at_line_end(); ++numbers)
        last = {last.y, cursor.any_number({})};
    header.has_colors |= header.color_words(numbers - first) > 0;
    if (header.has_textures && numbers - first >= 2) {
        given.uvs.values.resize(header.vertices, glm::dvec2(NAN));
        given.uvs.values[vertex] = {last.x, 1.0 - last.y};
    }
    if (numbers > kMostVertexNumbers)
        cursor.fail("vertex " + std::to_string(vertex) + " has " + std::to_string(numbers) +
                    " numbers, but at most " + std::to_string(kMostVertexNumbers) +
                    " have a meaning");
    return position;
}

void read_face(TextCursor& cursor, std::uint64_t face, const Header& header, Polygons& polygons)
{
    const auto name = [&] { return "face " + std::to_string(face); };
    if (!cursor.next_line())
        cursor.fail("the file ends, but " + name() + " of " + std::to_string(header.faces) +
                    " is missing");
    const std::int64_t size = cursor.integer({});
    if (size < 0)
        cursor.fail(name() + " has " + std::to_string(size) + " corners");
    for (std::int64_t i = 0; i < size; ++i) {
        if (cursor.at_line_end())
            cursor.fail(name() + " has " + std::to_string(i) + " corners, but says " +
                        std::to_string(size));
        const std::int64_t index = cursor.integer({});
        if (index < 0 || static_cast<std::uint64_t>(index) >= header.vertices)
            cursor.fail(name() + " uses vertex " + std::to_string(index) + ", but there are " +
                        std::to_string(header.vertices) + " vertices");
        polygons.corners.push_back(static_cast<std::uint32_t>(index));
    }
    close_polygon(polygons, static_cast<std::uint32_t>(size));
}

}  // namespace

Scene read_off(const std::string& file_name, std::string contents)
{
    const auto source = std::make_shared<OffSource>();
    source->text = std::move(contents);
    TextCursor cursor(file_name, source->text, kOffRules);
    Header& header = source->header;
    header = read_header(file_name, cursor);
    std::vector<glm::dvec3> positions;
    positions.reserve(header.vertices);
    PolygonCorners given;
    for (std::uint64_t v = 0; v < header.vertices; ++v)
        positions.push_back(read_vertex(cursor, v, header, given));
    Polygons polygons;
    for (std::uint64_t face = 0; face < header.faces; ++face)
        read_face(cursor, face, header, polygons);
    Scene scene = make_scene_of(file_name, std::move(positions), std::move(polygons), source,
                                std::move(given));
    add_note(scene.notes, header.is_glued, "space", "missing between OFF and the counts");
    return scene;
}

}  // namespace surfelao
