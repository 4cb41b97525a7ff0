#include "files/maker_mark.h"
#include "files/mesh_source.h"
#include "files/ply_file.h"
#include "files/ply_io.h"
#include "surfels/number_text.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

using namespace ply;

constexpr std::string_view kWrittenProperties[] = {
    "float occlusion", "float bent_nx", "float bent_ny", "float bent_nz",
    "uchar red",       "uchar green",   "uchar blue"};

template <class Properties>
void append_property_lines(std::string& text, const Properties& properties,
                           std::string_view newline)
{
    for (const auto& property : properties)
        text.append("property ").append(property).append(newline);
}

void append_mark_line(std::string& text, std::string_view mark, std::string_view newline)
{
    if (!mark.empty())
        text.append("comment ").append(mark).append(newline);
}

std::array<float, 4> floats_of(const Occlusion& o)
{
    return {o.occlusion, o.bent_normal.x, o.bent_normal.y, o.bent_normal.z};
}

void append_binary(std::string& text, const Occlusion& occlusion, std::endian endian)
{
    for (const float value : floats_of(occlusion))
        append_bytes(text, value, endian);
    text.append(3, static_cast<char>(grey(occlusion)));
}

void append_ascii(std::string& text, const Occlusion& occlusion)
{
    for (const float value : floats_of(occlusion)) {
        text += ' ';
        append_shortest(text, value);
    }
    for (int channel = 0; channel < 3; ++channel) {
        text += ' ';
        append_integer(text, grey(occlusion));
    }
}

bool is_written(std::string_view property)
{
    return std::ranges::any_of(kWrittenProperties, [&](std::string_view written) {
        return written.substr(written.find(' ') + 1) == property;
    });
}

/// The header of the source with the written properties behind the other ones of the vertex and
/// the mark behind the format; older ones of both are left out.
void append_header(std::string& text, const PlySource& source, std::string_view mark)
{
    const std::string_view old =
        std::string_view(source.contents).substr(0, source.header.data_begin);
    const std::string& newline = source.header.newline;
    const std::size_t insert_at = find_element(source.header, "vertex")->lines_end;
    std::size_t copied = 0;
    const auto copy_to = [&](std::size_t end) {
        text.append(old.substr(copied, end - copied));
        copied = end;
    };
    bool in_vertex = false;
    bool inserted = false;
    TextCursor cursor({}, old, {});
    while (cursor.next_line()) {
        const std::size_t line_begin = cursor.offset();
        if (!inserted && line_begin >= insert_at) {
            copy_to(insert_at);
            inserted = true;
            append_property_lines(text, kWrittenProperties, newline);
        }
        const std::string_view keyword = cursor.word();
        std::string_view last;
        if (keyword == "element")
            in_vertex = cursor.word() == "vertex";
        const std::size_t words_begin = cursor.at_line_end() ? copied : cursor.offset();
        while (!cursor.at_line_end())
            last = cursor.word();
        const std::size_t line_end = line_after(old, cursor.offset());
        const bool is_old_mark =
            keyword == "comment" &&
            !command_of_mark(old.substr(words_begin, cursor.offset() - words_begin)).empty();
        if (is_old_mark || (keyword == "property" && in_vertex && is_written(last))) {
            copy_to(line_begin);
            copied = line_end;
        } else if (keyword == "format") {
            copy_to(line_end);
            append_mark_line(text, mark, newline);
        }
    }
    text.append(old.substr(copied));
}

/// The source's file with every vertex row's written properties replaced.
template <class Data>
std::string spliced(const PlySource& source, std::span<const Occlusion> occlusion,
                    std::string_view mark)
{
    const Element& vertices = *find_element(source.header, "vertex");
    const bool ascii = source.header.format == Format::ascii;
    const std::endian endian =
        source.header.format == Format::big_endian ? std::endian::big : std::endian::little;
    std::string text;
    text.reserve(source.contents.size() + 256 + occlusion.size() * (ascii ? 60 : 19));
    append_header(text, source, mark);
    text.append(source.data().substr(0, source.vertices_begin));

    const std::string_view rows =
        source.data().substr(source.vertices_begin, source.vertices_end - source.vertices_begin);
    const std::string no_name;
    Data data(no_name, rows, source.header);
    std::size_t row_end = 0;
    for (std::uint64_t row = 0; row < vertices.count; ++row) {
        data.begin_row(vertices, row);
        text.append(rows.substr(row_end, data.offset() - row_end));
        for (const Property& property : vertices.properties) {
            const std::size_t begin = data.offset();
            skip_property(data, property);
            if (!is_written(property.name))
                text.append(rows.substr(begin, data.offset() - begin));
        }
        if (ascii)
            append_ascii(text, occlusion[row]);
        else
            append_binary(text, occlusion[row], endian);
        row_end = data.offset();
    }
    return text.append(source.data().substr(source.vertices_end));
}

/// Whether rounding to float would move some vertex by a visible share of the scene.
bool needs_double(const std::vector<glm::dvec3>& positions)
{
    glm::dvec3 low = positions[0];
    glm::dvec3 high = positions[0];
    double largest_shift = 0.0;
    for (const glm::dvec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
        const glm::dvec3 shift = glm::abs(p - glm::dvec3(glm::vec3(p)));
        largest_shift = std::max({largest_shift, shift.x, shift.y, shift.z});
    }
    return !(largest_shift <= kFloatSlack * glm::distance(low, high));
}

}  // namespace

std::string new_ply(const Scene& scene, const PlyValues& values, std::string_view mark,
                    PlyCoordinates coordinates)
{
    const bool wide = coordinates == PlyCoordinates::exact || needs_double(scene.positions);
    const bool many = scene.positions.size() > std::numeric_limits<std::int32_t>::max();
    std::size_t most_corners = 0;
    std::size_t corner_count = 0;
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        most_corners = std::max(most_corners, corners.size());
        corner_count += corners.size();
    });
    const bool big_polygons = most_corners > 255;
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    append_mark_line(text, mark, "\n");
    text += "element vertex ";
    append_integer(text, static_cast<std::int64_t>(scene.positions.size()));
    text += '\n';
    for (const char* axis : {"x\n", "y\n", "z\n"})
        text.append(wide ? "property double " : "property float ").append(axis);
    append_property_lines(text, values.properties, "\n");
    text += "element face ";
    append_integer(text, static_cast<std::int64_t>(face_count(scene)));
    text.append("\nproperty list ")
        .append(big_polygons ? "uint " : "uchar ")
        .append(many ? "uint" : "int")
        .append(" vertex_indices\nend_header\n");

    // of the values 19 bytes: what a bake has at a vertex
    text.reserve(text.size() + scene.positions.size() * (wide ? 43 : 31) +
                 face_count(scene) * (big_polygons ? 4 : 1) + corner_count * 4);
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            const double value = scene.positions[v][axis];
            if (wide)
                append_bytes(text, value);
            else
                append_bytes(text, static_cast<float>(value));
        }
        values.append(text, v);
    }
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        const std::uint32_t size = static_cast<std::uint32_t>(corners.size());
        if (big_polygons)
            append_bytes(text, size);
        else
            text += static_cast<char>(size);
        for (const std::uint32_t corner : corners)
            append_bytes(text, corner);
    });
    return text;
}

std::string ply_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                         std::string_view mark)
{
    const auto* source = dynamic_cast<const PlySource*>(scene.asset.get());
    if (!source) {
        const PlyValues values{{std::begin(kWrittenProperties), std::end(kWrittenProperties)},
                               [&](std::string& row, std::size_t v) {
                                   append_binary(row, occlusion[v], std::endian::little);
                               }};
        return new_ply(scene, values, mark);
    }
    return source->header.format == Format::ascii ? spliced<AsciiData>(*source, occlusion, mark)
                                                  : spliced<BinaryData>(*source, occlusion, mark);
}

}  // namespace surfelao
