#include "files/maker_mark.h"
#include "files/pcd_file.h"
#include "files/pcd_io.h"
#include "files/ply_file.h"
#include "files/vertex_rows.h"
#include "surfels/number_text.h"

namespace surfelao {
namespace {

using namespace pcd;

/// I, U or F.
char kind_of(Type type)
{
    switch (type) {
        case Type::float32:
        case Type::float64:
            return 'F';
        case Type::int8:
        case Type::int16:
        case Type::int32:
            return 'I';
        default:
            return 'U';
    }
}

Field field_of(const Column& column)
{
    std::string name = column.name;
    for (const char axis : {'x', 'y', 'z'}) {
        if (name == std::string("n") + axis)
            name = std::string("normal_") + axis;
    }
    return {std::move(name), size_of(column.type), kind_of(column.type), 1, 0};
}

/// What a line of the header says of a field.
void append_word(std::string& line, std::string_view keyword, const Field& field)
{
    line += ' ';
    if (keyword == "SIZE")
        append_integer(line, static_cast<std::int64_t>(field.size));
    else if (keyword == "TYPE")
        line += field.kind;
    else if (keyword == "COUNT")
        append_integer(line, static_cast<std::int64_t>(field.count));
    else
        line += field.name;
}

bool is_of_fields(std::string_view keyword)
{
    return keyword == "FIELDS" || keyword == "COLUMNS" || keyword == "SIZE" || keyword == "TYPE" ||
           keyword == "COUNT";
}

/// The source's header with the fields that come behind those that stay, and the mark.
std::string changed_header(const PcdSource& source, const VertexChanges& changes,
                           std::string_view mark)
{
    const std::string_view old = std::string_view(source.contents).substr(0, source.data_begin);
    const std::string_view line_end = line_end_of(old);
    std::vector<Field> fields;
    for (const Field& field : source.fields) {
        if (!changes.drops(source.points.properties[field.property].name))
            fields.push_back(field);
    }
    for (const Column& column : changes.added)
        fields.push_back(field_of(column));
    std::string text;
    std::size_t copied = 0;
    const auto copy_to = [&](std::size_t end) {
        text.append(old.substr(copied, end - copied));
        copied = end;
    };
    TextCursor cursor({}, old, {});
    while (cursor.next_line()) {
        const std::size_t begin = cursor.offset();
        const std::string_view keyword = cursor.word();
        const std::size_t keyword_end = cursor.offset();
        std::size_t end = keyword_end;
        while (!cursor.at_line_end()) {
            cursor.word();
            end = cursor.offset();
        }
        copy_to(begin);
        if (old.substr(begin).starts_with("# ") &&
            !command_of_mark(old.substr(begin + 2, end - begin - 2)).empty()) {
            copied = ply::line_after(old, cursor.offset());
        } else if (is_of_fields(keyword)) {
            if ((keyword == "FIELDS" || keyword == "COLUMNS") && !mark.empty())
                text.append("# ").append(mark).append(line_end);
            copy_to(keyword_end);
            for (const Field& field : fields)
                append_word(text, keyword, field);
            copied = end;
        } else if (keyword == "DATA" && source.kind == Kind::compressed) {
            text += "DATA binary";
            copied = end;
        }
    }
    copy_to(old.size());
    return text;
}

std::string new_header(const Scene& scene, const std::vector<Column>& columns,
                       std::string_view mark)
{
    std::string text = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
    if (!mark.empty())
        text.append("# ").append(mark).append("\n");
    for (const std::string_view keyword : {"FIELDS", "SIZE", "TYPE", "COUNT"}) {
        text += keyword;
        for (const Column& column : columns)
            append_word(text, keyword, field_of(column));
        text += '\n';
    }
    const auto count = static_cast<std::int64_t>(scene.positions.size());
    append_integer(text += "WIDTH ", count);
    text += "\nHEIGHT 1\nVIEWPOINT ";
    const glm::dvec3 place = scene.viewpoint.value_or(glm::dvec3(0.0));
    for (int axis = 0; axis < 3; ++axis) {
        append_shortest(text, place[axis]);
        text += " ";
    }
    append_integer(text += "1 0 0 0\nPOINTS ", count);
    return text += "\nDATA binary\n";
}

}  // namespace

WrittenFile pcd_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                         const WriteOptions& options)
{
    WrittenFile written;
    std::string& text = written.contents;
    if (const auto* source = dynamic_cast<const PcdSource*>(scene.asset.get())) {
        const VertexChanges changes = changes_of(*source, options, true, written.notes);
        text = changed_header(*source, changes, options.mark);
        append_changed_rows(text, *source, occlusion, changes);
        if (source->kind != Kind::compressed) {
            const std::string_view data =
                std::string_view(source->contents).substr(source->data_begin);
            text += data.substr(source->rows.size());
        } else {
            written.notes.push_back("compressed data become binary ones");
        }
        return written;
    }
    const NewRows rows(scene, occlusion, options, ColorForm::packed, written.notes);
    const Type type = needs_double(scene.positions) ? Type::float64 : Type::float32;
    std::vector<Column> columns{{type, "x"}, {type, "y"}, {type, "z"}};
    columns.insert(columns.end(), rows.columns().begin(), rows.columns().end());
    text = new_header(scene, columns, options.mark);
    text.reserve(text.size() + scene.positions.size() * 60);
    FilePlaces places(scene);
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        const glm::dvec3 place = places.next();
        for (int axis = 0; axis < 3; ++axis)
            append_channel(text, type, place[axis], {});
        rows.append(text, v, {});
    }
    return written;
}

}  // namespace surfelao
