#include "files/maker_mark.h"
#include "files/vertex_rows.h"
#include "files/xyz_file.h"
#include "files/xyz_io.h"
#include "surfels/extension.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

using namespace xyz;

/// Between the names of a line.
std::string_view separator_of(std::string_view header)
{
    for (const std::string_view separator : {";", ",", "\t"}) {
        if (header.find(separator) != header.npos)
            return separator;
    }
    return " ";
}

/// Whether a line of names belongs to the columns, those of an earlier result included.
bool fits(const XyzSource& source, const VertexChanges& changes)
{
    const std::vector<std::string_view> names = names_in(source.header);
    const std::vector<Property>& columns = source.points.properties;
    if (names.size() != columns.size())
        return false;
    for (std::size_t n = 0; n < names.size(); ++n) {
        if (changes.drops(columns[n].name) && plain_name(names[n]) != columns[n].name)
            return false;
    }
    return true;
}

/// The source's names of columns without those that go and with those that come.
std::string new_header(const XyzSource& source, const VertexChanges& changes)
{
    const std::vector<std::string_view> names = names_in(source.header);
    const std::vector<Property>& columns = source.points.properties;
    std::string header;
    const char* copied = source.header.data();
    for (std::size_t n = 0; n < names.size(); ++n) {
        const char* end = names[n].data() + names[n].size();
        if (!changes.drops(columns[n].name))
            header.append(copied, end);
        copied = end;
    }
    const std::string_view separator = separator_of(source.header);
    for (const Column& column : changes.added)
        header.append(separator).append(column.name);
    return header.append(copied, source.header.data() + source.header.size());
}

/// `# columns x y z occlusion` behind the points.
void append_columns(std::string& text, std::string line, std::span<const Column> added,
                    std::string_view line_end)
{
    for (const Column& column : added)
        line.append(column.name).append(" ");
    line.pop_back();
    text.append(line).append(line_end);
}

void append_mark(std::string& text, std::string_view mark, std::string_view line_end)
{
    if (!mark.empty())
        text.append("# ").append(mark).append(line_end);
}

std::string changed_text(const XyzSource& source, std::span<const Occlusion> occlusion,
                         const VertexChanges& changes, std::string_view mark)
{
    const std::string_view old = source.text;
    const std::string_view line_end = line_end_of(old);
    std::string text;
    const bool has_names = !source.header.empty() && fits(source, changes);
    if (!has_names) {
        text.append(old.substr(0, source.rows_begin));
    } else {
        const auto begin = static_cast<std::size_t>(source.header.data() - old.data());
        const std::size_t end = begin + source.header.size();
        text.append(old.substr(0, begin)).append(new_header(source, changes));
        text.append(old.substr(end, source.rows_begin - end));
    }
    append_changed_rows(text, source, occlusion, changes);
    if (text.back() != '\n' && text.back() != '\r')
        text += line_end;
    if (!has_names || !source.header_says_all) {
        std::string columns(kColumnsComment);
        for (const Property& property : source.points.properties) {
            if (!changes.drops(property.name))
                columns.append(as_word(property.name)).append(" ");
        }
        append_columns(text, std::move(columns), changes.added, line_end);
    }
    append_mark(text, mark, line_end);
    return text;
}

}  // namespace

WrittenFile xyz_contents(const std::filesystem::path& path, const Scene& scene,
                         std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    WrittenFile written;
    const auto* source = dynamic_cast<const XyzSource*>(scene.asset.get());
    const bool is_list = lower_extension(path) == ".pts";
    if (source && (source->is_list == is_list || source->has_count == is_list)) {
        const VertexChanges changes = changes_of(*source, options, true, written.notes);
        written.contents = changed_text(*source, occlusion, changes, options.mark);
        return written;
    }
    const NewRows rows(scene, occlusion, options, ColorForm::apart, written.notes);
    std::string& text = written.contents;
    add_note(written.notes, scene.placeless.size(), "point",
             "without a finite place left out: text has none");
    if (is_list) {
        append_integer(text,
                       static_cast<std::int64_t>(scene.positions.size() - scene.placeless.size()));
        text += '\n';
    }
    FilePlaces places(scene);
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        const glm::dvec3 place = places.next();
        if (std::isnan(place.x))
            continue;
        for (int axis = 0; axis < 3; ++axis)
            append_shortest(text.append(axis > 0 ? " " : ""), place[axis]);
        rows.append(text, v, {.ascii = true});
        text += '\n';
    }
    append_columns(text, std::string(kColumnsComment) + "x y z ", rows.columns(), "\n");
    append_mark(text, options.mark, "\n");
    return written;
}

}  // namespace surfelao
