#include "files/row_ranges.h"

#include "surfels/for_all.h"

#include <algorithm>
#include <string_view>

namespace surfelao::table {
namespace {

/// Without a branch, so that many bytes are looked at in one step.
template <class IsCounted>
std::uint64_t count_bytes(std::string_view text, const IsCounted& is_counted)
{
    std::uint64_t count = 0;
    for (std::size_t i = 0; i + 1 < text.size(); ++i)
        count += is_counted(text[i], text[i + 1]) ? 1 : 0;
    return count;
}

/// How many lines end in a text after which a line begins.
std::uint64_t line_ends(std::string_view text)
{
    const bool ends_with_one = !text.empty() && (text.back() == '\n' || text.back() == '\r');
    return count_bytes(text,
                       [](char c, char next) { return c == '\n' || (c == '\r' && next != '\n'); }) +
           (ends_with_one ? 1 : 0);
}

/// How many of the lines have a word.
std::uint64_t count_rows(TextCursor lines)
{
    std::uint64_t rows = 0;
    while (lines.next_line())
        ++rows;
    return rows;
}

}  // namespace

std::vector<RowRange> line_ranges(const TextCursor& cursor)
{
    const std::string_view text = cursor.text();
    std::vector<RowRange> ranges{{0, 0, cursor.offset(), cursor.line()}};
    while (text.size() - ranges.back().offset > 2 * kRangeBytes)
        ranges.push_back({0, 0, cursor.line_begin(ranges.back().offset + kRangeBytes), 0});
    std::vector<std::uint64_t> lines(ranges.size(), 0);
    for_tasks(ranges.size() - 1, [&](std::size_t i) {
        const std::size_t begin = ranges[i].offset;
        lines[i + 1] = line_ends(text.substr(begin, ranges[i + 1].offset - begin));
    });
    for (std::size_t i = 1; i < ranges.size(); ++i)
        ranges[i].line = ranges[i - 1].line + lines[i];
    return ranges;
}

std::vector<RowRange> row_ranges(const TextCursor& cursor, std::uint64_t count)
{
    std::vector<RowRange> ranges = line_ranges(cursor);
    std::vector<std::uint64_t> rows(ranges.size(), 0);
    for_tasks(ranges.size() - 1, [&](std::size_t i) {
        const RowRange& before = ranges[i];
        rows[i + 1] = count_rows(cursor.part(before.offset, ranges[i + 1].offset, before.line));
    });
    std::size_t used = 1;
    while (used < ranges.size() && ranges[used - 1].first + rows[used] < count) {
        ranges[used].first = ranges[used - 1].end = ranges[used - 1].first + rows[used];
        ++used;
    }
    ranges.resize(used);
    ranges.back().end = count;
    return ranges;
}

std::vector<RowRange> row_ranges(std::size_t offset, std::size_t bytes, std::size_t row_bytes,
                                 std::uint64_t count)
{
    const std::uint64_t rows = std::max<std::size_t>(1, kRangeBytes / row_bytes);
    const std::uint64_t there = std::min<std::uint64_t>(count, bytes / row_bytes);
    std::vector<RowRange> ranges{{0, count, offset, 0}};
    for (std::uint64_t first = rows; first < there; first += rows) {
        ranges.back().end = first;
        ranges.push_back({first, count, offset + first * row_bytes, 0});
    }
    return ranges;
}

}  // namespace surfelao::table
