#include "files/pcd_io.h"

#include "files/lzf.h"
#include "files/pcd_file.h"
#include "files/ply_file.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace surfelao {
namespace {

using namespace pcd;

/// Each is looked up among all; clouds have 20.
constexpr std::size_t kMostFields = 1000;

/// The lines of the header.
class HeaderReader {
public:
    HeaderReader(const std::string& file_name, PcdSource& source)
        : file_name_(file_name), source_(source), cursor_(file_name, source.contents, {})
    {
    }

    void run()
    {
        bool has_data = false;
        while (!has_data) {
            if (!cursor_.next_line())
                throw InputError(file_name_ + ": ends within the header (no line \"DATA\")");
            const std::string_view keyword = cursor_.word();
            if (keyword.starts_with('#'))
                continue;
            if (keyword == "FIELDS" || keyword == "COLUMNS")
                read_fields();
            else if (keyword == "SIZE")
                read_each("sizes", [&](Field& field) { field.size = count_of("a size"); });
            else if (keyword == "TYPE")
                read_each("types", [&](Field& field) { field.kind = cursor_.word().front(); });
            else if (keyword == "COUNT")
                read_each("counts", [&](Field& field) { field.count = count_of("a count"); });
            else if (keyword == "WIDTH")
                width_ = count_of("the width");
            else if (keyword == "HEIGHT")
                height_ = count_of("the height");
            else if (keyword == "POINTS")
                points_ = count_of("the number of points");
            else if (keyword == "VIEWPOINT")
                read_viewpoint();
            else if (keyword == "DATA")
                has_data = read_kind();
            else if (keyword != "VERSION")
                cursor_.fail(quoted(keyword) + " is not a word of a PCD header");
            if (keyword == "VERSION")
                cursor_.word();
            if (!cursor_.at_line_end())
                cursor_.fail(quoted(cursor_.word()) + " stands behind the end of the line");
        }
        source_.header_lines = cursor_.line();
        source_.data_begin = ply::line_after(source_.contents, cursor_.offset());
        finish();
    }

    std::optional<glm::dvec3> viewpoint;

private:
    [[noreturn]] void refuse(const std::string& fault) const
    {
        throw InputError(file_name_ + ": " + fault);
    }

    std::uint64_t count_of(std::string_view what)
    {
        const std::int64_t count = cursor_.integer(what);
        if (count < 0)
            cursor_.fail(std::string(what) + " is " + std::to_string(count));
        return static_cast<std::uint64_t>(count);
    }

    void read_fields()
    {
        if (!source_.fields.empty())
            cursor_.fail("a second line of fields");
        while (!cursor_.at_line_end()) {
            if (source_.fields.size() == kMostFields)
                cursor_.fail("there are more than " + std::to_string(kMostFields) + " fields");
            source_.fields.push_back({std::string(cursor_.word())});
        }
    }

    template <class Read>
    void read_each(const std::string& what, const Read& read)
    {
        for (Field& field : source_.fields) {
            if (cursor_.at_line_end())
                cursor_.fail("there are fewer " + what + " than " +
                             count_text(source_.fields.size(), "field"));
            read(field);
        }
    }

    void read_viewpoint()
    {
        glm::dvec3 place;
        for (int axis = 0; axis < 3; ++axis)
            place[axis] = cursor_.any_number("a coordinate of the viewpoint");
        viewpoint = as_viewpoint(place);
        while (!cursor_.at_line_end())  // how it was turned
            cursor_.any_number({});
    }

    bool read_kind()
    {
        const std::string_view word = cursor_.word();
        constexpr std::pair<std::string_view, Kind> kKinds[] = {
            {"ascii", Kind::ascii},
            {"binary", Kind::binary},
            {"binary_compressed", Kind::compressed}};
        for (const auto& [name, kind] : kKinds) {
            if (name == word) {
                source_.kind = kind;
                return true;
            }
        }
        cursor_.fail("the kind of data " + quoted(word) + " is not known");
    }

    /// What the counts and the fields come to, after the last line.
    void finish()
    {
        if (source_.fields.empty())
            refuse("the header has no line \"FIELDS\"");
        if (width_ && (*width_ > kMostElements || height_ > kMostElements))
            refuse("the header says " + std::to_string(*width_) + " x " + std::to_string(height_) +
                   " points, which is more than can be used");
        if (!width_ && !points_)
            refuse("the header says neither WIDTH nor POINTS");
        const std::uint64_t count = points_ ? *points_ : *width_ * height_;
        if (width_ && *width_ * height_ != count)
            refuse("the header says " + std::to_string(*width_) + " x " + std::to_string(height_) +
                   " points, but POINTS " + std::to_string(count));
        if (count == 0)
            refuse("has no points");
        source_.points.name = "point";
        source_.points.count = count;
        source_.points.packs_colors = true;
        for (Field& field : source_.fields)
            add_properties(field);
        for (const std::string_view axis : {"x", "y", "z"}) {
            if (find_scalar(source_.points, axis) == source_.points.properties.size())
                refuse("the line FIELDS names no number " + std::string(axis));
        }
    }

    void add_properties(Field& field)
    {
        const auto fail = [&](const std::string& fault) {
            refuse("the field " + surfelao::quoted(field.name) + " has " + fault);
        };
        const std::optional<Type> type = type_of(field);
        if (!type)
            fail("the type " + surfelao::quoted({&field.kind, 1}) + " of " +
                 std::to_string(field.size) + " bytes, which is not known");
        // in ascii a blank or the line's end stands behind each
        if (field.count == 0 || field.count > source_.contents.size())
            fail("the count " + std::to_string(field.count));
        least_bytes_ += field.count;
        if (least_bytes_ > source_.contents.size())
            fail("more numbers than the file can hold");
        // an integer of 8 bytes has no type of ours, and numbers of an array no name
        const bool is_named = field.count == 1 && (field.size < 8 || field.kind == 'F');
        const std::string name(is_named ? plain_name(field.name) : "-");
        field.property = source_.points.properties.size();
        for (std::uint64_t i = 0; i < field.count; ++i)
            source_.points.properties.push_back({name, std::nullopt, *type, false});
        Property& first = source_.points.properties[field.property];
        first.is_second = find_scalar(source_.points, name) < field.property;
        if (first.is_second && (name == "x" || name == "y" || name == "z"))
            fail("another of its name before it");
    }

    static std::string_view plain_name(std::string_view name)
    {
        constexpr std::string_view kNormals[][2] = {
            {"normal_x", "nx"}, {"normal_y", "ny"}, {"normal_z", "nz"}};
        for (const auto& [other, plain] : kNormals) {
            if (name == other)
                return plain;
        }
        return name;
    }

    static std::optional<Type> type_of(const Field& field)
    {
        constexpr std::pair<std::string_view, std::array<Type, 4>> kTypes[] = {
            {"I", {Type::int8, Type::int16, Type::int32, Type::float64}},
            {"U", {Type::uint8, Type::uint16, Type::uint32, Type::float64}}};
        if (field.kind == 'F')
            return field.size == 4   ? std::optional(Type::float32)
                   : field.size == 8 ? std::optional(Type::float64)
                                     : std::nullopt;
        for (const auto& [kind, types] : kTypes) {
            for (std::size_t power = 0; power < 4; ++power) {
                if (kind.front() == field.kind && field.size == (std::size_t{1} << power))
                    return types[power];
            }
        }
        return std::nullopt;
    }

    const std::string& file_name_;
    PcdSource& source_;
    TextCursor cursor_;
    std::optional<std::uint64_t> width_, points_;
    std::uint64_t height_ = 1;
    std::uint64_t least_bytes_ = 0;
};

/// Bytes of a point in binary data.
std::uint64_t stride_of(const PcdSource& source)
{
    return BinaryData::least_bytes(source.points);
}

[[noreturn]] void refuse_size(const std::string& file_name, const PcdSource& source,
                              std::uint64_t bytes)
{
    throw InputError(file_name + ": the header says " + count_text(source.points.count, "point") +
                     " of " + count_text(stride_of(source), "byte") + ", but the data have " +
                     std::to_string(bytes));
}

std::uint32_t number_at(std::string_view data, std::size_t at)
{
    std::uint32_t number = 0;
    for (std::size_t byte = 4; byte-- > 0;)
        number = number << 8 | static_cast<unsigned char>(data[at + byte]);
    return number;
}

/// Compressed data hold field by field what binary data hold point by point.
std::string unpacked(const std::string& file_name, const PcdSource& source, std::string_view data)
{
    if (data.size() < 8)
        throw InputError(file_name + ": the compressed data are cut: the file ends");
    const std::uint64_t packed_size = number_at(data, 0), size = number_at(data, 4);
    if (packed_size > data.size() - 8)
        throw InputError(file_name + ": the compressed data have " + std::to_string(packed_size) +
                         " bytes, but the file ends after " + std::to_string(data.size() - 8));
    const std::uint64_t stride = stride_of(source), count = source.points.count;
    if (size / stride != count || size % stride != 0)
        refuse_size(file_name, source, size);
    const std::optional<std::string> columns = unpack_lzf(data.substr(8, packed_size), size);
    if (!columns)
        throw InputError(file_name + ": the compressed data do not unpack to " +
                         std::to_string(size) + " bytes");
    std::string rows(size, '\0');
    std::size_t begin = 0, in_row = 0;
    for (const Field& field : source.fields) {
        const std::size_t bytes = field.size * field.count;
        for (std::uint64_t point = 0; point < count; ++point)
            std::memcpy(&rows[point * stride + in_row], &(*columns)[begin + point * bytes], bytes);
        begin += bytes * count;
        in_row += bytes;
    }
    return rows;
}

VertexValues read_ascii(const std::string& file_name, PcdSource& source, std::string_view data,
                        const std::vector<Role>& roles)
{
    if (source.points.count > (data.size() + 1) / AsciiData::least_bytes(source.points))
        throw InputError(file_name + ": the header says " +
                         count_text(source.points.count, "point") +
                         ", but the file is too short for that");
    AsciiData rows(file_name, data, source.form());
    VertexValues values = read_vertices(rows, source.points, roles);
    source.rows = data.substr(0, rows.offset());
    TextCursor rest(file_name, data.substr(rows.offset()), {},
                    source.header_lines + source.points.count);
    if (rest.next_line())
        rest.fail(quoted(rest.word()) + " stands behind the last of " +
                  count_text(source.points.count, "point"));
    return values;
}

VertexValues read_binary(const std::string& file_name, PcdSource& source, std::string_view data,
                         const std::vector<Role>& roles)
{
    if (source.kind == Kind::compressed) {
        source.unpacked = unpacked(file_name, source, data);
        data = source.unpacked;
    }
    const std::uint64_t stride = stride_of(source);
    if (source.points.count > data.size() / stride)
        refuse_size(file_name, source, data.size());
    source.rows = data.substr(0, source.points.count * stride);
    BinaryData rows(file_name, source.rows, source.form());
    return read_vertices(rows, source.points, roles);
}

}  // namespace

Scene read_pcd(const std::string& file_name, std::string contents)
{
    const auto source = std::make_shared<PcdSource>();
    source->contents = std::move(contents);
    HeaderReader header(file_name, *source);
    header.run();
    const std::vector<Role> roles = roles_of(file_name, source->points);
    const std::string_view data = std::string_view(source->contents).substr(source->data_begin);
    VertexValues values = source->kind == Kind::ascii
                              ? read_ascii(file_name, *source, data, roles)
                              : read_binary(file_name, *source, data, roles);
    PolygonCorners given;
    given.normals.values = std::move(values.normals);
    Scene scene =
        make_scene_of(file_name, std::move(values.positions), {}, source, std::move(given));
    scene.viewpoint = header.viewpoint;
    return scene;
}

}  // namespace surfelao
