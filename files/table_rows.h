/// table_rows.h: rows of numbers as PLY, PCD and text clouds have them: what their columns are, and
/// a walk through them. Internal to the readers and writers of these formats.
#pragma once

#include "files/mesh_source.h"
#include "files/own_colors.h"
#include "files/row_ranges.h"
#include "files/text_cursor.h"
#include "surfels/errors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao::table {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes in a binary file.
inline std::size_t size_of(Type type)
{
    constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

inline bool is_integer(Type type)
{
    return type != Type::float32 && type != Type::float64;
}

struct Property {
    std::string name;
    std::optional<Type> count_type;  ///< of a list
    Type type = Type::int8;
    bool is_second = false;  ///< the element has another of this name, which comes first
};

/// Of clouds in text and PCD, so that memory does not depend on the length of a line, and names can
/// be looked up one by one. Scanners and laser files have 30.
inline constexpr std::size_t kMostColumns = 1000;

/// Of these, what is left for a result's own.
inline constexpr std::size_t kResultColumns = 20;

/// Rows of numbers: the vertices of a PLY, the points of a PCD or of a text file.
struct Element {
    std::string name;
    std::uint64_t count = 0;  ///< rows
    std::vector<Property> properties;
    std::size_t lines_end = 0;  ///< PLY: byte behind the last header line of this element
    bool packs_colors = false;  ///< PCD: `rgb` or `rgba` is one number, 0xRRGGBB in its bits
};

enum class Format : std::uint8_t { ascii, little_endian, big_endian };

/// How the numbers of rows stand in a file.
struct RowForm {
    Format format = Format::ascii;
    std::uint64_t first_line = 1;  ///< ascii: the line on which the rows begin
    TextRules rules = {};          ///< ascii
};

/// Which property of the element is the scalar of this name; none: past the last.
[[nodiscard]] std::size_t find_scalar(const Element& element, std::string_view name);

/// The bits of a number of this type that packs a colour; white for what is no number.
[[nodiscard]] std::uint32_t packed_bits(Type type, double number);

/// What the rows of vertices say of them; without any of a kind: empty.
struct VertexValues {
    std::vector<glm::dvec3> positions;  ///< any numbers
    std::vector<glm::vec3> normals;     ///< any numbers
    std::vector<glm::dvec2> uvs;        ///< as UvSet has them; nan for what is no number
};

/// What a column of vertices is: all axes of a kind are there, or none.
struct Role {
    enum { none, position, normal, uv } kind = none;
    int axis = 0;
};

/// The roles of the properties. Throws InputError where x, y or z is missing.
[[nodiscard]] std::vector<Role> roles_of(const std::string& file_name, const Element& vertices);

/// "face 12", also for names that are too long or too strange for a sentence.
[[nodiscard]] std::string row_name(const Element& element, std::uint64_t row);

/// red, green, blue among the properties of the vertex.
using Channels = std::array<std::size_t, 3>;

/// Where the colours of the vertices stand.
///
/// A result has the visibility behind its other properties (`bent_nz red green blue`) where its
/// source had no colours; else in their place, and the source's behind its own properties
/// (`bent_nz own_red own_green own_blue`). So the order tells whose they are.
struct ColorPlaces {
    /// Scalars `red green blue`, also `diffuse_red ...`, `r ...`, `diffuse_r ...`. None where a
    /// result made them of nothing.
    std::optional<Channels> shown;
    /// The file's own: those that are shown, or `own_red own_green own_blue` of the same types.
    std::optional<Channels> own;
    std::optional<std::size_t> alpha;  ///< if there are any
    /// All three are in one property, `rgb` or `rgba`; the file's own then in `own_rgb`.
    bool packed = false;
};
[[nodiscard]] ColorPlaces color_places(const Element& vertices);

/// Whether a property of this name may be part of a colour.
[[nodiscard]] bool names_color(std::string_view property);

/// What white is for numbers of this type. largest: of the file's numbers.
[[nodiscard]] double white_of(Type type, double largest);

/// "uchar", also "uint8"; none for any other word.
[[nodiscard]] std::optional<Type> type_named(std::string_view name);

/// "uchar"
[[nodiscard]] std::string_view name_of(Type type);

/// A file whose vertices are rows, for its writer.
class RowSource : public MeshSource {
public:
    [[nodiscard]] virtual const Element& vertices() const = 0;
    [[nodiscard]] virtual std::string_view vertex_rows() const = 0;
    [[nodiscard]] virtual RowForm form() const = 0;

    struct Own {
        std::vector<glm::vec4> colors;  ///< own_colors()
        double largest = 0.0;           ///< of the numbers in the file
    };
    [[nodiscard]] Own own() const;
    [[nodiscard]] std::vector<glm::vec4> own_colors() const override { return own().colors; }
};

/// Rows of numbers in an ascii file: one row, one line.
class AsciiData {
public:
    /// rows: from the beginning of some row on.
    AsciiData(const std::string& file_name, std::string_view rows, const RowForm& form)
        : cursor_(file_name, rows, form.rules, form.first_line)
    {
    }

    /// The fewest bytes that one row takes.
    static std::size_t least_bytes(const Element& element) { return 2 * element.properties.size(); }

    /// Of the next rows, which are those of the element.
    [[nodiscard]] std::vector<RowRange> ranges(const Element& element) const
    {
        return row_ranges(cursor_, element.count);
    }
    /// Before a range of rows, in which next comes begin_row().
    [[nodiscard]] AsciiData at(const RowRange& range) const
    {
        AsciiData rows = *this;
        rows.cursor_ = cursor_.part(range.offset, offset() + remaining(), range.line);
        return rows;
    }

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
    /// May be infinite or nan.
    double any_number(Type)
    {
        demand_word();
        return cursor_.any_number({});
    }
    std::int64_t integer(Type)
    {
        demand_word();
        return cursor_.integer({});
    }
    /// nan for what is no number.
    double loose_number(Type)
    {
        demand_word();
        return number_in(cursor_.word()).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    std::uint32_t bits(Type type) { return packed_bits(type, loose_number(type)); }
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
        cursor_.fail(row_name(*element_, row_) + " " + fault);
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
    BinaryData(const std::string& file_name, std::string_view rows, const RowForm& form)
        : file_name_(&file_name),
          rows_(rows),
          swapped_((form.format == Format::big_endian) != (std::endian::native == std::endian::big))
    {
    }

    static std::size_t least_bytes(const Element& element)
    {
        std::size_t bytes = 0;
        for (const Property& property : element.properties)
            bytes += size_of(property.count_type.value_or(property.type));
        return bytes;
    }

    /// As those of AsciiData. Rows with lists are stepped through to find them.
    [[nodiscard]] std::vector<RowRange> ranges(const Element& element) const;
    [[nodiscard]] BinaryData at(const RowRange& range) const
    {
        BinaryData rows = *this;
        rows.offset_ = range.offset;
        return rows;
    }

    void begin_row(const Element& element, std::uint64_t row)
    {
        element_ = &element;
        row_ = row;
    }
    void end_row() {}
    /// May be infinite or nan.
    double any_number(Type type)
    {
        switch (type) {
            case Type::float32:
                return std::bit_cast<float>(take<std::uint32_t>());
            case Type::float64:
                return std::bit_cast<double>(take<std::uint64_t>());
            default:
                return static_cast<double>(integer(type));
        }
    }
    double loose_number(Type type) { return any_number(type); }
    std::uint32_t bits(Type) { return take<std::uint32_t>(); }
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
        throw InputError(*file_name_ + ": " + row_name(*element_, row_) + " " + fault);
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

    const std::string* file_name_;
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

/// As UvSet has it: in the file v runs up.
inline double uv_number(double number, int axis)
{
    return axis == 0 ? number : 1.0 - number;
}

template <class Data>
void skip_property(Data& data, const Property& property)
{
    std::uint64_t count = 1;
    if (property.count_type)
        count = read_length(data, property);
    data.skip(property.type, count);
}

/// All rows of the vertices, which begin at the data's place; all threads.
template <class Data>
VertexValues read_vertices(Data& data, const Element& vertices, const std::vector<Role>& roles)
{
    VertexValues values;
    values.positions.resize(vertices.count);
    if (std::ranges::find(roles, Role::normal, &Role::kind) != roles.end())
        values.normals.resize(vertices.count);
    if (std::ranges::find(roles, Role::uv, &Role::kind) != roles.end())
        values.uvs.resize(vertices.count);
    const auto read_row = [&](Data& rows, std::uint64_t row) {
        rows.begin_row(vertices, row);
        for (std::size_t p = 0; p < roles.size(); ++p) {
            const Property& property = vertices.properties[p];
            const auto [kind, axis] = roles[p];
            if (kind == Role::position)
                values.positions[row][axis] = rows.any_number(property.type);
            else if (kind == Role::normal)
                values.normals[row][axis] = static_cast<float>(rows.any_number(property.type));
            else if (kind == Role::uv)
                values.uvs[row][axis] = uv_number(rows.loose_number(property.type), axis);
            else
                skip_property(rows, property);
        }
        rows.end_row();
    };
    const std::vector<RowRange> ranges = data.ranges(vertices);
    for_each_range(data, ranges, [&](Data& rows, std::size_t i) {
        for (std::uint64_t row = ranges[i].first; row < ranges[i].end; ++row)
            read_row(rows, row);
    });
    return values;
}

}  // namespace surfelao::table
