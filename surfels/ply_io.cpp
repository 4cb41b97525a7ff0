#include "surfels/ply_io.h"

#include "surfels/errors.h"
#include "surfels/mesh_source.h"
#include "surfels/number_text.h"
#include "surfels/text_cursor.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace surfelao {
namespace {

// ---- header -------------------------------------------------------------------------------------

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
    std::string_view name;
    Type type;
};
constexpr TypeName kTypeNames[] = {
    {"char", Type::int8},      {"uchar", Type::uint8},    {"short", Type::int16},
    {"ushort", Type::uint16},  {"int", Type::int32},      {"uint", Type::uint32},
    {"float", Type::float32},  {"double", Type::float64}, {"int8", Type::int8},
    {"uint8", Type::uint8},    {"int16", Type::int16},    {"uint16", Type::uint16},
    {"int32", Type::int32},    {"uint32", Type::uint32},  {"float32", Type::float32},
    {"float64", Type::float64}};

std::size_t size_of(Type type)
{
    constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

bool is_integer(Type type)
{
    return type != Type::float32 && type != Type::float64;
}

struct Property {
    std::string name;
    std::optional<Type> count_type;  ///< of a list
    Type type = Type::int8;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
    std::size_t lines_end = 0;  ///< byte behind the last header line of this element
};

enum class Format : std::uint8_t { ascii, little_endian, big_endian };

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::size_t data_begin = 0;    ///< first byte behind the header
    std::uint64_t line_count = 0;  ///< lines of the header
    std::string newline;
};

Type read_type(TextCursor& cursor)
{
    const std::string_view word = cursor.word();
    for (const TypeName& entry : kTypeNames) {
        if (entry.name == word)
            return entry.type;
    }
    cursor.fail(quoted(word) + " is not a type");
}

Property read_property(TextCursor& cursor, const Element& element)
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
    property.name = cursor.word();
    if (property.name.empty())
        cursor.fail("the property has no name");
    for (const Property& other : element.properties) {
        if (other.name == property.name) {
            cursor.fail("element " + quoted(element.name) + " has two properties " +
                        quoted(property.name));
        }
    }
    return property;
}

Element read_element(TextCursor& cursor, const Header& header)
{
    Element element;
    element.name = cursor.word();
    if (element.name.empty())
        cursor.fail("the element has no name");
    for (const Element& other : header.elements) {
        if (other.name == element.name)
            cursor.fail("a second element " + quoted(element.name));
    }
    const std::int64_t count = cursor.integer("the count of the element");
    if (count < 0)
        cursor.fail("element " + quoted(element.name) + " has the negative count " +
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

/// The end of a line that stands at this byte.
std::string newline_at(std::string_view contents, std::size_t offset)
{
    const std::string_view rest = contents.substr(offset, 2);
    if (rest == "\r\n")
        return "\r\n";
    return std::string(rest.substr(0, 1));
}

std::size_t line_after(std::string_view contents, std::size_t offset)
{
    return offset + newline_at(contents, offset).size();
}

Header read_header(const std::string& file_name, std::string_view contents)
{
    Header header;
    TextCursor cursor(file_name, contents, {});
    if (!cursor.next_line() || cursor.word() != "ply" || !cursor.at_line_end())
        throw InputError(file_name + ": does not begin with the line \"ply\"");
    header.newline = newline_at(contents, cursor.offset());
    bool has_format = false;
    while (true) {
        if (!cursor.next_line())
            throw InputError(file_name + ": ends within the header (no line \"end_header\")");
        const std::string_view keyword = cursor.word();
        if (keyword == "end_header")
            break;
        if (keyword == "comment" || keyword == "obj_info")
            continue;
        if (keyword == "format") {
            header.format = read_format(cursor);
            has_format = true;
        } else if (keyword == "element") {
            header.elements.push_back(read_element(cursor, header));
        } else if (keyword == "property") {
            if (header.elements.empty())
                cursor.fail("a property before the first element");
            Element& element = header.elements.back();
            element.properties.push_back(read_property(cursor, element));
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

// ---- data ---------------------------------------------------------------------------------------

/// Rows of numbers in an ascii file: one row, one line.
class AsciiData {
public:
    /// rows: from the beginning of some row on; lines are counted from the end of the header.
    AsciiData(const std::string& file_name, std::string_view rows, const Header& header)
        : cursor_(file_name, rows, {}, header.line_count + 1)
    {
    }

    /// The fewest bytes that one row takes.
    static std::size_t least_bytes(const Element& element) { return 2 * element.properties.size(); }

    void begin_row(const Element& element, std::uint64_t row)
    {
        element_ = &element;
        row_ = row;
        if (!cursor_.next_line())
            fail("of " + std::to_string(element.count) + " is missing: the file ends");
    }
    void end_row()
    {
        if (!cursor_.at_line_end())
            fail("has more numbers than the header says");
    }
    double number(Type)
    {
        demand_word();
        return cursor_.number({});
    }
    std::int64_t integer(Type)
    {
        demand_word();
        return cursor_.integer({});
    }
    void skip(Type, std::uint64_t count)
    {
        for (; count > 0; --count) {
            demand_word();
            cursor_.word();
        }
    }
    [[nodiscard]] std::size_t remaining() const { return cursor_.remaining(); }
    [[nodiscard]] std::size_t offset() const { return cursor_.offset(); }
    [[noreturn]] void fail(const std::string& fault) const
    {
        cursor_.fail(element_->name + " " + std::to_string(row_) + " " + fault);
    }

private:
    void demand_word()
    {
        if (cursor_.at_line_end())
            fail("has fewer numbers than the header says");
    }

    TextCursor cursor_;
    const Element* element_ = nullptr;
    std::uint64_t row_ = 0;
};

/// Rows of numbers in a binary file.
class BinaryData {
public:
    BinaryData(const std::string& file_name, std::string_view rows, const Header& header)
        : file_name_(file_name),
          rows_(rows),
          swapped_((header.format == Format::big_endian) !=
                   (std::endian::native == std::endian::big))
    {
    }

    static std::size_t least_bytes(const Element& element)
    {
        std::size_t bytes = 0;
        for (const Property& property : element.properties)
            bytes += size_of(property.count_type.value_or(property.type));
        return bytes;
    }

    void begin_row(const Element& element, std::uint64_t row)
    {
        element_ = &element;
        row_ = row;
    }
    void end_row() {}
    double number(Type type)
    {
        double value = 0.0;
        switch (type) {
            case Type::float32:
                value = std::bit_cast<float>(take<std::uint32_t>());
                break;
            case Type::float64:
                value = std::bit_cast<double>(take<std::uint64_t>());
                break;
            default:
                value = static_cast<double>(integer(type));
        }
        if (!std::isfinite(value))
            fail("has the coordinate " + std::string(std::isnan(value) ? "nan" : "inf") +
                 ", which is not finite");
        return value;
    }
    std::int64_t integer(Type type)
    {
        switch (type) {
            case Type::int8:
                return static_cast<std::int8_t>(take<std::uint8_t>());
            case Type::uint8:
                return take<std::uint8_t>();
            case Type::int16:
                return static_cast<std::int16_t>(take<std::uint16_t>());
            case Type::uint16:
                return take<std::uint16_t>();
            case Type::int32:
                return static_cast<std::int32_t>(take<std::uint32_t>());
            default:
                return take<std::uint32_t>();
        }
    }
    void skip(Type type, std::uint64_t count)
    {
        if (count > remaining() / size_of(type))
            fail_at_end();
        offset_ += count * size_of(type);
    }
    [[nodiscard]] std::size_t remaining() const { return rows_.size() - offset_; }
    [[nodiscard]] std::size_t offset() const { return offset_; }
    [[noreturn]] void fail(const std::string& fault) const
    {
        throw InputError(file_name_ + ": " + element_->name + " " + std::to_string(row_) + " " +
                         fault);
    }

private:
    template <class Unsigned>
    Unsigned take()
    {
        if (remaining() < sizeof(Unsigned))
            fail_at_end();
        unsigned char bytes[sizeof(Unsigned)];
        std::memcpy(bytes, rows_.data() + offset_, sizeof(Unsigned));
        if (swapped_)
            std::reverse(bytes, bytes + sizeof(Unsigned));
        offset_ += sizeof(Unsigned);
        Unsigned value = 0;
        std::memcpy(&value, bytes, sizeof(Unsigned));
        return value;
    }
    [[noreturn]] void fail_at_end() const
    {
        fail("of " + std::to_string(element_->count) + " is cut: the file ends");
    }

    const std::string& file_name_;
    std::string_view rows_;
    std::size_t offset_ = 0;
    bool swapped_;
    const Element* element_ = nullptr;
    std::uint64_t row_ = 0;
};

/// The length of a list.
template <class Data>
std::uint64_t read_length(Data& data, const Property& property)
{
    const std::int64_t length = data.integer(*property.count_type);
    if (length < 0)
        data.fail("has a list of negative length " + std::to_string(length));
    // a list cannot be longer than what is left of the file
    if (static_cast<std::uint64_t>(length) > data.remaining())
        data.fail("has a list of length " + std::to_string(length) + ", but the file ends");
    return static_cast<std::uint64_t>(length);
}

template <class Data>
void skip_property(Data& data, const Property& property)
{
    std::uint64_t count = 1;
    if (property.count_type)
        count = read_length(data, property);
    data.skip(property.type, count);
}

// ---- reading ------------------------------------------------------------------------------------

class PlySource : public MeshSource {
public:
    std::string contents;
    Header header;
    std::size_t vertices_begin = 0;  ///< bytes of the vertex rows, counted from the data's first
    std::size_t vertices_end = 0;

    [[nodiscard]] std::string_view data() const
    {
        return std::string_view(contents).substr(header.data_begin);
    }
};

const Element* find_element(const Header& header, std::string_view name)
{
    const auto found = std::ranges::find(header.elements, name, &Element::name);
    return found == header.elements.end() ? nullptr : &*found;
}

/// Which property of the element is the list of vertex indices.
std::size_t index_list(const std::string& file_name, const Element& element)
{
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (property.name != "vertex_indices" && property.name != "vertex_index")
            continue;
        if (!property.count_type || !is_integer(property.type)) {
            throw InputError(file_name + ": property " + quoted(property.name) + " of element " +
                             quoted(element.name) + " is not a list of integers");
        }
        return p;
    }
    throw InputError(file_name + ": element " + quoted(element.name) +
                     " has no list \"vertex_indices\"");
}

template <class Data>
class Reader {
public:
    Reader(const std::string& file_name, PlySource& source)
        : file_name_(file_name), source_(source), data_(file_name, source.data(), source.header)
    {
        const Element* vertices = find_element(source.header, "vertex");
        if (!vertices)
            throw InputError(file_name + ": has no element \"vertex\"");
        vertex_count_ = vertices->count;
    }

    void run()
    {
        for (const Element& element : source_.header.elements) {
            check_size(element);
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face" && element.count > 0)
                read_lists(element, [this](std::uint64_t n) { read_face(n); });
            else if (element.name == "tristrips" && element.count > 0)
                read_lists(element, [this](std::uint64_t n) { read_strips(n); });
            else
                skip_rows(element);
        }
    }

    std::vector<glm::dvec3> positions;
    Polygons polygons;

private:
    /// Refuses a count for which the file is too short before anything of that size is reserved.
    void check_size(const Element& element) const
    {
        const std::size_t least = Data::least_bytes(element);
        // the last row of an ascii file may go without the end of its line
        if (least > 0 && element.count > (data_.remaining() + 1) / least) {
            throw InputError(file_name_ + ": the header says " + std::to_string(element.count) +
                             " of element " + quoted(element.name) +
                             ", but the file is too short for that");
        }
    }

    void read_vertices(const Element& element)
    {
        // what each property is: a coordinate, or 3 = passed over
        std::vector<int> axis_of(element.properties.size(), 3);
        constexpr std::string_view kAxes[] = {"x", "y", "z"};
        for (int axis = 0; axis < 3; ++axis) {
            const auto found = std::ranges::find(element.properties, kAxes[axis], &Property::name);
            if (found == element.properties.end() || found->count_type) {
                throw InputError(file_name_ + ": element \"vertex\" has no scalar property " +
                                 quoted(kAxes[axis]));
            }
            axis_of[static_cast<std::size_t>(found - element.properties.begin())] = axis;
        }
        source_.vertices_begin = data_.offset();
        positions.resize(element.count);
        for (std::uint64_t row = 0; row < element.count; ++row) {
            data_.begin_row(element, row);
            for (std::size_t p = 0; p < axis_of.size(); ++p) {
                if (axis_of[p] < 3)
                    positions[row][axis_of[p]] = data_.number(element.properties[p].type);
                else
                    skip_property(data_, element.properties[p]);
            }
            data_.end_row();
        }
        source_.vertices_end = data_.offset();
    }

    template <class ReadList>
    void read_lists(const Element& element, const ReadList& read_list)
    {
        const std::size_t list = index_list(file_name_, element);
        index_type_ = element.properties[list].type;
        for (std::uint64_t row = 0; row < element.count; ++row) {
            data_.begin_row(element, row);
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                if (p == list)
                    read_list(read_length(data_, element.properties[p]));
                else
                    skip_property(data_, element.properties[p]);
            }
            data_.end_row();
        }
    }

    std::uint32_t checked(std::int64_t index) const
    {
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) {
            data_.fail("uses vertex " + std::to_string(index) + ", but there are " +
                       std::to_string(vertex_count_) + " vertices");
        }
        return static_cast<std::uint32_t>(index);
    }

    void read_face(std::uint64_t length)
    {
        if (length < 3)
            data_.fail("has " + std::to_string(length) + " corners, but needs 3");
        for (std::uint64_t i = 0; i < length; ++i)
            polygons.corners.push_back(checked(data_.integer(index_type_)));
        close_polygon(polygons, static_cast<std::uint32_t>(length));
    }

    void read_strips(std::uint64_t length)
    {
        std::array<std::uint32_t, 3> last{};
        std::uint64_t in_strip = 0;
        for (std::uint64_t i = 0; i < length; ++i) {
            const std::int64_t index = data_.integer(index_type_);
            if (index == -1) {
                in_strip = 0;
                continue;
            }
            last = {last[1], last[2], checked(index)};
            if (++in_strip < 3 || last[0] == last[1] || last[1] == last[2] || last[0] == last[2])
                continue;
            if (in_strip % 2 == 0)  // every other triangle of a strip is wound the other way
                polygons.corners.insert(polygons.corners.end(), {last[1], last[0], last[2]});
            else
                polygons.corners.insert(polygons.corners.end(), {last[0], last[1], last[2]});
            close_polygon(polygons, 3);
        }
    }

    void skip_rows(const Element& element)
    {
        if (element.properties.empty())
            return;
        for (std::uint64_t row = 0; row < element.count; ++row) {
            data_.begin_row(element, row);
            for (const Property& property : element.properties)
                skip_property(data_, property);
            data_.end_row();
        }
    }

    const std::string& file_name_;
    PlySource& source_;
    Data data_;
    std::uint64_t vertex_count_ = 0;
    Type index_type_ = Type::int32;
};

template <class Data>
Scene read_with(const std::string& file_name, std::shared_ptr<PlySource> source)
{
    Reader<Data> reader(file_name, *source);
    reader.run();
    return make_mesh_scene(file_name, std::move(reader.positions), std::move(reader.polygons),
                           std::move(source));
}

}  // namespace

Scene read_ply(const std::string& file_name, std::string contents)
{
    auto source = std::make_shared<PlySource>();
    source->contents = std::move(contents);
    source->header = read_header(file_name, source->contents);
    if (source->header.format == Format::ascii)
        return read_with<AsciiData>(file_name, std::move(source));
    return read_with<BinaryData>(file_name, std::move(source));
}

// ---- writing ------------------------------------------------------------------------------------

namespace {

constexpr std::string_view kWrittenProperties[] = {"occlusion", "bent_nx", "bent_ny", "bent_nz",
                                                   "red",       "green",   "blue"};

void append_property_lines(std::string& text, std::string_view newline)
{
    for (std::size_t p = 0; p < std::size(kWrittenProperties); ++p)
        text.append(p < 4 ? "property float " : "property uchar ")
            .append(kWrittenProperties[p])
            .append(newline);
}

std::uint8_t grey(const Occlusion& occlusion)
{
    return static_cast<std::uint8_t>(
        std::lround(255.0 * (1.0 - static_cast<double>(occlusion.occlusion))));
}

template <class Value>
void append_bytes(std::string& text, Value value, std::endian endian)
{
    char bytes[sizeof(Value)];
    std::memcpy(bytes, &value, sizeof(Value));
    if (endian != std::endian::native)
        std::reverse(bytes, bytes + sizeof(Value));
    text.append(bytes, sizeof(Value));
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
    return std::ranges::find(kWrittenProperties, property) != std::end(kWrittenProperties);
}

/// The header of the source with the written properties behind the other ones of the vertex.
void append_header(std::string& text, const PlySource& source)
{
    const std::string_view old =
        std::string_view(source.contents).substr(0, source.header.data_begin);
    const std::size_t insert_at = find_element(source.header, "vertex")->lines_end;
    std::size_t copied = 0;
    bool in_vertex = false;
    TextCursor cursor({}, old, {});
    while (copied < insert_at && cursor.next_line()) {
        const std::size_t line_begin = cursor.offset();
        if (line_begin >= insert_at)
            break;
        const std::string_view keyword = cursor.word();
        std::string_view last;
        if (keyword == "element")
            in_vertex = cursor.word() == "vertex";
        while (!cursor.at_line_end())
            last = cursor.word();
        if (keyword == "property" && in_vertex && is_written(last)) {
            text.append(old.substr(copied, line_begin - copied));
            copied = line_after(old, cursor.offset());
        }
    }
    text.append(old.substr(copied, insert_at - copied));
    append_property_lines(text, source.header.newline);
    text.append(old.substr(insert_at));
}

/// The source's file with every vertex row's written properties replaced.
template <class Data>
std::string spliced(const PlySource& source, std::span<const Occlusion> occlusion)
{
    const Element& vertices = *find_element(source.header, "vertex");
    const bool ascii = source.header.format == Format::ascii;
    const std::endian endian =
        source.header.format == Format::big_endian ? std::endian::big : std::endian::little;
    std::string text;
    text.reserve(source.contents.size() + 256 + occlusion.size() * (ascii ? 60 : 19));
    append_header(text, source);
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

std::string new_file(const Scene& scene, std::span<const Occlusion> occlusion)
{
    const bool wide = needs_double(scene.positions);
    const bool many = scene.positions.size() > std::numeric_limits<std::int32_t>::max();
    std::size_t most_corners = 0;
    std::size_t corner_count = 0;
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        most_corners = std::max(most_corners, corners.size());
        corner_count += corners.size();
    });
    const bool big_polygons = most_corners > 255;
    std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex ";
    append_integer(text, static_cast<std::int64_t>(scene.positions.size()));
    text += '\n';
    for (const char* axis : {"x\n", "y\n", "z\n"})
        text.append(wide ? "property double " : "property float ").append(axis);
    append_property_lines(text, "\n");
    text += "element face ";
    append_integer(text, static_cast<std::int64_t>(face_count(scene)));
    text.append("\nproperty list ")
        .append(big_polygons ? "uint " : "uchar ")
        .append(many ? "uint" : "int")
        .append(" vertex_indices\nend_header\n");

    text.reserve(text.size() + scene.positions.size() * (wide ? 43 : 31) +
                 face_count(scene) * (big_polygons ? 4 : 1) + corner_count * 4);
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            const double value = scene.positions[v][axis];
            if (wide)
                append_bytes(text, value, std::endian::little);
            else
                append_bytes(text, static_cast<float>(value), std::endian::little);
        }
        append_binary(text, occlusion[v], std::endian::little);
    }
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        const std::uint32_t size = static_cast<std::uint32_t>(corners.size());
        if (big_polygons)
            append_bytes(text, size, std::endian::little);
        else
            text += static_cast<char>(size);
        for (const std::uint32_t corner : corners)
            append_bytes(text, corner, std::endian::little);
    });
    return text;
}

}  // namespace

std::string ply_contents(const Scene& scene, std::span<const Occlusion> occlusion)
{
    const auto* source = dynamic_cast<const PlySource*>(scene.asset.get());
    if (!source)
        return new_file(scene, occlusion);
    return source->header.format == Format::ascii ? spliced<AsciiData>(*source, occlusion)
                                                  : spliced<BinaryData>(*source, occlusion);
}

}  // namespace surfelao
