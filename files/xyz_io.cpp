#include "files/xyz_io.h"

#include "files/maker_mark.h"
#include "files/xyz_file.h"
#include "surfels/errors.h"
#include "surfels/extension.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <sstream>

namespace surfelao {
namespace {

using namespace xyz;

constexpr std::string_view kBlanks = " \t\v\f";
constexpr std::string_view kEnds = "\r\n";

/// So that memory does not depend on the length of a line; scanners and laser files have 30.
constexpr std::size_t kMostColumns = 1000;

/// Of a line that names columns, in bytes.
constexpr std::size_t kLongestNames = 1u << 14;

std::string_view trimmed(std::string_view text)
{
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);  // npos + 1 is 0
}

std::string lower(std::string_view text)
{
    std::string result(text);
    for (char& c : result)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return result;
}

/// A column's name as color_places() and roles_of() know it.
std::string plain_name(std::string_view word)
{
    constexpr std::pair<std::string_view, std::string_view> kOthers[] = {
        {"normal_x", "nx"}, {"normal_y", "ny"}, {"normal_z", "nz"}, {"rf", "r"},
        {"gf", "g"},        {"bf", "b"},        {"i", "intensity"}};
    const std::string name = lower(word);
    for (const auto& [other, plain] : kOthers) {
        if (name == other)
            return std::string(plain);
    }
    return name;
}

using ColumnNames = std::vector<std::string>;

/// None where the line is longer than kLongestNames.
ColumnNames plain_names(std::string_view line)
{
    ColumnNames names;
    if (line.size() > kLongestNames)
        return names;
    for (const std::string_view name : names_in(line))
        names.push_back(plain_name(name));
    return names;
}

bool names_places(const ColumnNames& names)
{
    return std::ranges::all_of(
        std::initializer_list<std::string>{"x", "y", "z"},
        [&](const std::string& axis) { return std::ranges::count(names, axis) == 1; });
}

/// The lines in front of the points.
struct Lead {
    std::optional<std::uint64_t> count;
    std::uint64_t count_line = 0;
    std::string_view header;  ///< the words that name the columns; empty: none
    bool is_comment = false;  ///< and whether a comment does, which may mean something else
    std::size_t end = 0;      ///< where the line of the first point begins
    std::uint64_t line = 1;   ///< its number
    std::string_view first;   ///< that line
};

bool is_comment(std::string_view line)
{
    return line.starts_with('#') || line.starts_with("//");
}

/// The words of a comment: `//X Y Z`.
std::string_view comment_words(std::string_view line)
{
    return trimmed(line.substr(std::min(line.find_first_not_of("#/"), line.size())));
}

/// The next line of the text, without blanks around it, and where the one behind it begins.
struct Line {
    std::string_view words;
    std::size_t end = 0;
};

Line line_at(std::string_view text, std::size_t at)
{
    const std::size_t end = std::min(text.find_first_of(kEnds, at), text.size());
    return {trimmed(text.substr(at, end - at)), end + (text.substr(end).starts_with("\r\n") ? 2
                                                       : end < text.size()                  ? 1
                                                                                            : 0)};
}

/// is_told: a line of names may name the columns in any way.
Lead read_lead(const std::string& file_name, std::string_view text, bool is_told)
{
    Lead lead;
    std::size_t at = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    for (; at < text.size(); ++lead.line) {
        const Line line = line_at(text, at);
        const auto fail = [&](const std::string& fault) {
            TextCursor(file_name, {}, {}, lead.line).fail(fault);
        };
        const std::string_view first = line.words.substr(0, line.words.find_first_of(" \t,;"));
        if (line.words.empty()) {
        } else if (is_comment(line.words)) {
            const std::string_view words = comment_words(line.words);
            if (names_places(plain_names(words)) && (lead.header.empty() || lead.is_comment)) {
                lead.header = words;
                lead.is_comment = true;
            }
        } else if (first == line.words && number_in(first) && !lead.count &&
                   line.end < text.size()) {
            TextCursor cursor(file_name, first, {}, lead.line);
            const std::int64_t count = cursor.integer({});
            if (count < 0)
                fail("the number of points is " + std::to_string(count));
            lead.count = static_cast<std::uint64_t>(count);
            lead.count_line = lead.line;
        } else if (!number_in(first) && (is_told || names_places(plain_names(line.words)))) {
            lead.header = line.words;
            lead.is_comment = false;
            is_told = false;
        } else if (!number_in(first)) {
            fail(quoted(first) + " is not a number, and the line does not name columns x y z");
        } else {
            lead.end = lead.line == 1 ? 0 : at;
            lead.first = line.words.substr(0, line.words.find('#'));
            return lead;
        }
        at = line.end;
    }
    throw InputError(file_name + ": has no points");
}

/// What stands in the columns.
struct ColumnFacts {
    std::size_t columns = 0;
    std::uint64_t rows = 0;
    std::vector<double> largest;            ///< whole numbers of 0 on; negative: others are there
    std::vector<std::uint64_t> unit_count;  ///< points at which this and the next two are a normal
};

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// looked_at: the columns whose numbers count; empty: all from the fourth on.
ColumnFacts look_at(TextCursor cursor, const std::vector<bool>& looked_at)
{
    ColumnFacts facts;
    std::vector<double> numbers;
    while (cursor.next_line()) {
        std::size_t column = 0;
        for (; !cursor.at_line_end(); ++column) {
            const std::string_view word = cursor.word();
            if (column == kMostColumns)
                cursor.fail("the point has more than " + std::to_string(kMostColumns) + " columns");
            if (facts.rows == 0) {
                facts.largest.push_back(0.0);
                numbers.push_back(0.0);
            }
            if (column >= numbers.size() || (looked_at.empty() && column < 3) ||
                (column < looked_at.size() && !looked_at[column]))
                continue;
            const double number = number_in(word).value_or(kNoNumber);
            numbers[column] = number;
            double& largest = facts.largest[column];
            if (largest >= 0.0)
                largest = number >= 0.0 && number == std::floor(number) ? std::max(largest, number)
                                                                        : -1.0;
        }
        if (column != numbers.size())
            cursor.fail("the point has " + count_text(column, "column") + ", but the first has " +
                        std::to_string(numbers.size()));
        facts.unit_count.resize(numbers.size());
        for (std::size_t c = 3; c + 2 < numbers.size() && looked_at.empty(); ++c) {
            const double squared = numbers[c] * numbers[c] + numbers[c + 1] * numbers[c + 1] +
                                   numbers[c + 2] * numbers[c + 2];
            facts.unit_count[c] += squared >= 0.81 && squared <= 1.21 ? 1 : 0;
        }
        ++facts.rows;
    }
    facts.columns = numbers.size();
    return facts;
}

/// The names of columns by what stands in them.
ColumnNames guess(const ColumnFacts& facts, bool is_pts)
{
    ColumnNames names(facts.columns);
    const auto take = [&](std::size_t first, std::initializer_list<const char*> axes) {
        for (const char* axis : axes)
            names[first++] = axis;
    };
    const auto are_free = [&](std::size_t c) {
        return names[c].empty() && names[c + 1].empty() && names[c + 2].empty();
    };
    take(0, {"x", "y", "z"});
    for (std::size_t c = 3; c + 2 < names.size(); ++c) {
        if (facts.unit_count[c] * 100 >= facts.rows * 99) {
            take(c, {"nx", "ny", "nz"});
            break;
        }
    }
    const auto is_byte = [&](std::size_t c) {
        return facts.largest[c] >= 0.0 && facts.largest[c] <= 255.0;
    };
    std::size_t colors = 0;
    for (std::size_t c = 3; c + 2 < names.size() && (colors == 0 || is_pts); ++c) {
        if (are_free(c) && is_byte(c) && is_byte(c + 1) && is_byte(c + 2))
            colors = c;
    }
    if (colors > 0)
        take(colors, {"r", "g", "b"});
    const bool is_single = std::ranges::count(names, "") == 1;
    for (std::size_t c = 3; c < names.size(); ++c) {
        if (names[c].empty())
            names[c] = is_single ? "intensity" : "column_" + std::to_string(c + 1);
    }
    return names;
}

/// What a result says of itself behind its points.
struct Tail {
    std::size_t begin = 0;
    ColumnNames columns;  ///< none: it does not say
};

Tail read_tail(std::string_view text)
{
    Tail tail;
    while (true) {
        const std::size_t end = text.find_last_not_of(kEnds) + 1;
        tail.begin = text.substr(0, end).find_last_of(kEnds) + 1;  // npos + 1 is 0
        const std::string_view line = text.substr(tail.begin, end - tail.begin);
        if (line.starts_with(kColumnsComment)) {
            if (tail.columns.empty() && line.size() <= kLongestNames) {
                for (const std::string_view name : names_in(line.substr(kColumnsComment.size())))
                    tail.columns.emplace_back(name);
            }
        } else if (off_mark(text).line.empty()) {
            tail.begin = text.size();
            if (!names_places(tail.columns))
                tail.columns.clear();
            return tail;
        }
        text = text.substr(0, tail.begin);
    }
}

/// Makes the columns of the points; numbers of colours are whole where all of them are.
void set_columns(XyzSource& source, const ColumnNames& names, TextCursor cursor, ColumnFacts& facts)
{
    Element& points = source.points;
    for (const std::string& name : names)
        points.properties.push_back({name, std::nullopt, Type::float64,
                                     find_scalar(points, name) < points.properties.size()});
    const ColorPlaces colors = color_places(points);
    std::vector<bool> looked_at(names.size(), false);
    for (const std::optional<Channels>& channels : {colors.shown, colors.own}) {
        for (std::size_t c = 0; channels && c < 3; ++c)
            looked_at[(*channels)[c]] = true;
    }
    if (facts.columns == 0)
        facts = look_at(std::move(cursor), looked_at);
    Type type = Type::uint8;
    for (std::size_t c = 0; c < std::min(facts.columns, names.size()); ++c) {
        if (!looked_at[c])
            continue;
        if (facts.largest[c] < 0.0 || facts.largest[c] > 65535.0)
            type = Type::float32;
        else if (facts.largest[c] > 255.0 && type == Type::uint8)
            type = Type::uint16;
    }
    for (std::size_t c = 0; c < names.size(); ++c)
        points.properties[c].type = looked_at[c] ? type : Type::float64;
    points.count = facts.rows;
}

/// Refuses a number of columns that is not the one of the names.
void check_count(TextCursor cursor, std::size_t columns, std::size_t names)
{
    if (columns >= 3 && columns == names)
        return;
    cursor.next_line();
    cursor.fail("the point has " + count_text(columns, "column") + ", but " +
                (columns < 3 ? "x y z are 3" : "those named are " + std::to_string(names)));
}

/// Of the first point.
std::size_t columns_in(TextCursor cursor)
{
    std::size_t columns = 0;
    for (cursor.next_line(); !cursor.at_line_end(); ++columns)
        cursor.word();
    return columns;
}

char separator_in(std::string_view row)
{
    for (const char separator : {';', ','}) {
        if (row.find(separator) != row.npos)
            return separator;
    }
    return ' ';
}

/// Refuses points that are nowhere.
void check_places(const std::string& file_name, const XyzSource& source,
                  const std::vector<glm::dvec3>& positions)
{
    const auto lost = std::ranges::find_if_not(positions, [](const glm::dvec3& p) {
        return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
               std::abs(p.z) <= kLargestCoordinate;
    });
    if (lost == positions.end())
        return;
    AsciiData data(file_name, source.vertex_rows(), source.form());
    const auto row = static_cast<std::uint64_t>(lost - positions.begin());
    for (std::uint64_t before = 0; before <= row; ++before)
        data.begin_row(source.points, before);
    std::ostringstream fault;
    fault << "lies at " << lost->x << ' ' << lost->y << ' ' << lost->z
          << ", but coordinates are finite and up to " << kLargestCoordinate;
    data.fail(fault.str());
}

}  // namespace

std::vector<std::string_view> xyz::names_in(std::string_view line)
{
    std::vector<std::string_view> names;
    const bool is_list = line.find_first_of(",;") != line.npos;
    const std::string_view between = is_list ? ",;" : kBlanks;
    while (!line.empty()) {
        const std::string_view name = trimmed(line.substr(0, line.find_first_of(between)));
        if (!name.empty())
            names.push_back(name);
        const std::size_t end = line.find_first_of(between);
        line.remove_prefix(end == line.npos ? line.size() : end + 1);
    }
    return names;
}

void check_columns(const std::string& columns)
{
    require(columns.empty() || names_places(plain_names(columns)),
            "columns are told as in \"x y z r g b\", with x, y and z once each");
}

Scene read_xyz(const std::string& file_name, std::string contents, const std::string& columns)
{
    check_columns(columns);
    ColumnNames names = plain_names(columns);
    const auto source = std::make_shared<XyzSource>();
    source->text = std::move(contents);
    const std::string_view text = source->text;
    static_cast<void>(TextCursor(file_name, text, {}));  // refuses UTF-16

    const Tail tail = read_tail(text);
    source->rows_end = tail.begin;
    const Lead lead = read_lead(file_name, text.substr(0, source->rows_end),
                                !columns.empty() || !tail.columns.empty());
    source->has_count = lead.count.has_value();
    source->is_list = lower_extension(file_name) == ".pts";
    source->rows_begin = lead.end;
    source->row_form = {Format::ascii,
                        lead.line,
                        {.comment = '#', .slashes = true, .separator = separator_in(lead.first)}};
    source->points.name = "point";

    const TextCursor cursor(file_name, source->vertex_rows(), source->row_form.rules, lead.line);
    ColumnNames named = plain_names(lead.header);
    if (lead.is_comment && named.size() != columns_in(cursor))
        named.clear();
    else
        source->header = lead.header;
    const ColumnNames& of_file = tail.columns.empty() ? named : tail.columns;
    // what is told is of the file as it was before a result
    for (std::size_t c = names.size(); c < of_file.size(); ++c)
        names.push_back(of_file[c]);
    source->header_says_all = !names.empty() && named == names;
    ColumnFacts facts;
    if (names.empty()) {
        facts = look_at(cursor, {});
        if (facts.columns >= 3)
            names = guess(facts, source->is_list);
    }
    set_columns(*source, names, cursor, facts);
    check_count(cursor, facts.columns, names.size());
    if (lead.count && *lead.count != facts.rows)
        TextCursor(file_name, {}, {}, lead.count_line)
            .fail("says " + count_text(*lead.count, "point") + ", but " +
                  std::to_string(facts.rows) + " follow");
    AsciiData data(file_name, source->vertex_rows(), source->form());
    VertexValues values = read_vertices(data, source->points, roles_of(file_name, source->points));
    check_places(file_name, *source, values.positions);
    PolygonCorners given;
    given.normals.values = std::move(values.normals);
    return make_scene_of(file_name, std::move(values.positions), {}, source, std::move(given));
}

}  // namespace surfelao
