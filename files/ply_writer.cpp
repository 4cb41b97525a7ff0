#include "files/maker_mark.h"
#include "files/mesh_source.h"
#include "files/own_colors.h"
#include "files/ply_file.h"
#include "files/ply_io.h"
#include "files/sidecars.h"
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

constexpr std::string_view kMeasured[] = {"float occlusion", "float bent_nx", "float bent_ny",
                                          "float bent_nz"};
constexpr std::string_view kColor[] = {"red", "green", "blue"};
constexpr std::string_view kOwnColor[] = {"own_red", "own_green", "own_blue"};

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

/// How numbers stand in the rows of a file.
struct Notation {
    bool ascii = false;
    std::endian endian = std::endian::little;
};

void append_measured(std::string& text, const Occlusion& o, Notation notation)
{
    for (const float value : {o.occlusion, o.bent_normal.x, o.bent_normal.y, o.bent_normal.z}) {
        if (notation.ascii)
            append_shortest(text += ' ', value);
        else
            append_bytes(text, value, notation.endian);
    }
}

/// A channel of a colour, white being `white`.
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

void append_color_bytes(std::string& text, const glm::vec3& numbers, Notation notation)
{
    for (int channel = 0; channel < 3; ++channel) {
        if (notation.ascii)
            text += ' ';
        append_channel(text, Type::uint8, byte_of(numbers[channel]), notation);
    }
}

bool names(std::span<const std::string_view> properties, std::string_view name)
{
    return std::ranges::any_of(properties, [&](std::string_view property) {
        return property.substr(property.find(' ') + 1) == name;  // npos + 1 is 0
    });
}

/// What becomes of a file's vertices.
struct VertexChanges {
    ColorPlaces places;
    ColorPlan plan;
    double largest = 0.0;                          ///< of the numbers of the file's colours
    std::vector<std::string> new_properties = {};  ///< behind the others: "float occlusion"

    /// An earlier result's, or in the way of one of ours.
    [[nodiscard]] bool drops(std::string_view property) const
    {
        return names(kMeasured, property) || names(kOwnColor, property) ||
               (!places.shown && names(kColor, property));
    }
};

VertexChanges changes_of(const PlySource& source, const WriteOptions& options,
                         std::vector<std::string>& notes)
{
    const Element& vertices = *find_element(source.header, "vertex");
    PlySource::Own own = source.own();
    VertexChanges changes{
        color_places(vertices),
        plan_colors(options, std::move(own.colors), OcclusionPlace::beside, notes), own.largest};
    changes.new_properties.assign(std::begin(kMeasured), std::end(kMeasured));
    for (std::size_t c = 0; c < 3; ++c) {
        std::string line;
        if (changes.plan.replaces())
            line.append(name_of(vertices.properties[(*changes.places.own)[c]].type))
                .append(" ")
                .append(kOwnColor[c]);
        else if (!changes.plan.has_own() && changes.plan.writes())
            line.append("uchar ").append(kColor[c]);
        if (!line.empty())
            changes.new_properties.push_back(std::move(line));
    }
    return changes;
}

/// The header of the source with the new properties behind the others of the vertex, the mark
/// behind the format and names of files as they are reached from `folder`; older properties and
/// marks are left out.
class HeaderWriter {
public:
    HeaderWriter(const PlySource& source, const VertexChanges& changes,
                 std::filesystem::path folder)
        : source_(source), changes_(changes), folder_(std::move(folder))
    {
    }

    std::string write(std::string_view mark)
    {
        const std::size_t insert_at = find_element(source_.header, "vertex")->lines_end;
        bool inserted = false;
        TextCursor cursor({}, old_, {});
        while (cursor.next_line()) {
            if (!inserted && cursor.offset() >= insert_at) {
                copy_to(insert_at);
                inserted = true;
                append_property_lines(text_, changes_.new_properties, source_.header.newline);
            }
            write_line(cursor, mark);
        }
        copy_to(old_.size());
        return std::move(text_);
    }

    std::vector<std::string> missing;  ///< names of files that are not there

private:
    void copy_to(std::size_t end)
    {
        text_.append(old_.substr(copied_, end - copied_));
        copied_ = end;
    }

    void write_line(TextCursor& cursor, std::string_view mark)
    {
        const std::size_t line_begin = cursor.offset();
        const std::string_view keyword = cursor.word();
        std::string_view last;
        if (keyword == "element")
            in_vertex_ = cursor.word() == "vertex";
        const std::size_t words_begin = cursor.at_line_end() ? line_begin : cursor.offset();
        while (!cursor.at_line_end())
            last = cursor.word();
        const std::size_t words_end = cursor.offset();
        const std::size_t line_end = line_after(old_, words_end);
        const std::string_view words = old_.substr(words_begin, words_end - words_begin);
        const bool is_comment = keyword == "comment";
        if ((is_comment && !command_of_mark(words).empty()) ||
            (keyword == "property" && in_vertex_ && changes_.drops(last))) {
            copy_to(line_begin);
            copied_ = line_end;
        } else if (is_comment && words.starts_with(kTextureKeyword)) {
            copy_to(words_begin + kTextureKeyword.size());
            text_ += names_from(folder_, source_.folder, old_.substr(copied_, words_end - copied_),
                                missing);
            copied_ = words_end;
        } else if (keyword == "format") {
            copy_to(line_end);
            append_mark_line(text_, mark, source_.header.newline);
        }
    }

    const PlySource& source_;
    const VertexChanges& changes_;
    std::filesystem::path folder_;
    std::string_view old_ = std::string_view(source_.contents).substr(0, source_.header.data_begin);
    std::string text_;
    std::size_t copied_ = 0;  ///< bytes of the old header
    bool in_vertex_ = false;
};

/// The number itself, without the blanks that stand before it in an ascii file.
std::string_view word_of(std::string_view property, Notation notation)
{
    if (notation.ascii)
        property.remove_prefix(std::min(property.find_first_not_of(" \t\v\f"), property.size()));
    return property;
}

/// Appends the rows of the vertices with what changes.
template <class Data>
void append_vertex_rows(std::string& text, const PlySource& source,
                        std::span<const Occlusion> occlusion, const VertexChanges& changes)
{
    const Element& vertices = *find_element(source.header, "vertex");
    const std::vector<Property>& properties = vertices.properties;
    const Notation notation{
        source.header.format == Format::ascii,
        source.header.format == Format::big_endian ? std::endian::big : std::endian::little};
    const ColorPlan& plan = changes.plan;
    constexpr int kStays = -1, kGoes = -2;
    std::vector<int> fates(properties.size(), kStays);  // or a channel of the colour
    for (std::size_t p = 0; p < fates.size(); ++p)
        fates[p] = changes.drops(properties[p].name) ? kGoes : kStays;
    for (int c = 0; c < 3 && changes.places.shown; ++c)
        fates[(*changes.places.shown)[static_cast<std::size_t>(c)]] = c;
    std::vector<std::string_view> old(properties.size());
    const auto own_word = [&](std::size_t c) {
        return word_of(old[(*changes.places.own)[c]], notation);
    };

    const std::string_view rows = source.vertex_rows();
    const std::string no_name;
    Data data(no_name, rows, source.header);
    std::size_t row_end = 0;
    for (std::uint64_t row = 0; row < vertices.count; ++row) {
        data.begin_row(vertices, row);
        text.append(rows.substr(row_end, data.offset() - row_end));
        for (std::size_t p = 0; p < old.size(); ++p) {
            const std::size_t begin = data.offset();
            skip_property(data, properties[p]);
            old[p] = rows.substr(begin, data.offset() - begin);
        }
        row_end = data.offset();
        glm::vec3 numbers(0.0f);
        if (plan.what != VertexColors::keep)
            numbers = plan.numbers(row, occlusion[row]);
        for (std::size_t p = 0; p < old.size(); ++p) {
            if (fates[p] == kStays)
                text.append(old[p]);
            if (fates[p] < 0)
                continue;
            const std::string_view word = word_of(old[p], notation);
            text.append(old[p].substr(0, old[p].size() - word.size()));
            const Type type = properties[p].type;
            if (plan.what == VertexColors::keep)
                text.append(own_word(static_cast<std::size_t>(fates[p])));
            else
                append_channel(text, type, numbers[fates[p]] * white_of(type, changes.largest),
                               notation);
        }
        append_measured(text, occlusion[row], notation);
        if (!plan.has_own() && plan.writes())
            append_color_bytes(text, numbers, notation);
        for (std::size_t c = 0; c < 3 && plan.replaces(); ++c)
            text.append(notation.ascii ? " " : "").append(own_word(c));
    }
    text.append(rows.substr(row_end));
}

WrittenFile spliced(const PlySource& source, std::span<const Occlusion> occlusion,
                    const WriteOptions& options, const std::filesystem::path& folder)
{
    WrittenFile written;
    const VertexChanges changes = changes_of(source, options, written.notes);
    HeaderWriter header(source, changes, folder);
    std::string& text = written.contents;
    text = header.write(options.mark);
    note_missing(header.missing, written.notes);
    const bool ascii = source.header.format == Format::ascii;
    text.reserve(source.contents.size() + text.size() + occlusion.size() * (ascii ? 60 : 19));
    text.append(source.data().substr(0, source.vertices_begin));
    if (ascii)
        append_vertex_rows<AsciiData>(text, source, occlusion, changes);
    else
        append_vertex_rows<BinaryData>(text, source, occlusion, changes);
    text.append(source.data().substr(source.vertices_end));
    return written;
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

WrittenFile ply_contents(const std::filesystem::path& path, const Scene& scene,
                         std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    if (const auto* source = dynamic_cast<const PlySource*>(scene.asset.get()))
        return spliced(*source, occlusion, options, path.parent_path());
    WrittenFile written;
    const ColorPlan plan =
        plan_colors(options, own_colors_of(scene), OcclusionPlace::beside, written.notes);
    const auto shown = [&](std::size_t v) {
        return plan.what == VertexColors::keep ? numbers_of(plan.own[v])
                                               : plan.numbers(v, occlusion[v]);
    };
    PlyValues values;
    const auto add_color = [&](std::span<const std::string_view> names) {
        for (const std::string_view name : names)
            values.properties.push_back("uchar " + std::string(name));
    };
    if (plan.has_own())
        add_color(kColor);
    values.properties.insert(values.properties.end(), std::begin(kMeasured), std::end(kMeasured));
    if (plan.replaces())
        add_color(kOwnColor);
    else if (!plan.has_own() && plan.writes())
        add_color(kColor);
    values.append = [&](std::string& row, std::size_t v) {
        if (plan.has_own())
            append_color_bytes(row, shown(v), {});
        append_measured(row, occlusion[v], {});
        if (plan.replaces())
            append_color_bytes(row, numbers_of(plan.own[v]), {});
        else if (!plan.has_own() && plan.writes())
            append_color_bytes(row, shown(v), {});
    };
    written.contents = new_ply(scene, values, options.mark);
    return written;
}

}  // namespace surfelao
