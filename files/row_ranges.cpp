#include "files/row_ranges.h"

#include <algorithm>

namespace surfelao::table {

std::vector<RowRange> row_ranges(const TextCursor& cursor, std::uint64_t count)
{
    const std::size_t end = cursor.offset() + cursor.remaining();
    std::vector<RowRange> ranges{{0, count, cursor.offset(), cursor.line()}};
    while (end - ranges.back().offset > 2 * kRangeBytes)
        ranges.push_back({0, count, cursor.line_begin(ranges.back().offset + kRangeBytes), 1});
    if (ranges.size() == 1)
        return ranges;
    struct Counts {
        std::uint64_t rows, lines;
    };
    std::vector<Counts> counts(ranges.size());
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t i) {
        const std::size_t range_end = i + 1 < ranges.size() ? ranges[i + 1].offset : end;
        TextCursor lines = cursor.part(ranges[i].offset, range_end, 0);
        std::uint64_t rows = 0;
        while (lines.next_line())
            ++rows;
        counts[i] = {rows, lines.line()};
    });
    std::size_t used = 1;
    for (; used < ranges.size() && ranges[used - 1].first + counts[used - 1].rows < count; ++used) {
        RowRange& before = ranges[used - 1];
        before.end = ranges[used].first = before.first + counts[used - 1].rows;
        ranges[used].line = before.line + counts[used - 1].lines;
    }
    ranges.resize(used);
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
