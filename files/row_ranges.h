/// row_ranges.h: rows of numbers, read by all threads: where ranges of them begin. Internal to the
/// readers of rows.
#pragma once

#include "files/text_cursor.h"
#include "surfels/for_all.h"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

namespace surfelao::table {

struct RowRange {
    std::uint64_t first = 0, end = 0;  ///< rows
    std::size_t offset = 0;            ///< byte position where the first one's line begins
    std::uint64_t line = 0;            ///< of text: the number of that line
};

/// Ranges of about kRangeBytes that make up the text that remains, without numbers of rows. A line
/// that is joined with another one is in the same range. O(bytes), all threads.
[[nodiscard]] std::vector<RowRange> line_ranges(const TextCursor& cursor);

/// The same that make up the next `count` lines with a word; the last one goes
/// up to `count` where the text ends before.
[[nodiscard]] std::vector<RowRange> row_ranges(const TextCursor& cursor, std::uint64_t count);

/// The same of rows of equal size in `bytes` of data that remain from `offset` on. O(ranges).
[[nodiscard]] std::vector<RowRange> row_ranges(std::size_t offset, std::size_t bytes,
                                               std::size_t row_bytes, std::uint64_t count);

/// What a thread takes at once: large enough that starting it costs nothing beside.
inline constexpr std::size_t kRangeBytes = std::size_t{1} << 18;

/// Calls body(i) for 0 to count - 1 on all threads. Where several throw, the lowest i is heard: the
/// first fault in the file's order.
template <class Body>
void for_each_in_order(std::size_t count, const Body& body)
{
    std::vector<std::exception_ptr> faults(count);
    for_tasks(count, [&](std::size_t i) {
        try {
            body(i);
        } catch (...) {
            faults[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& fault : faults) {
        if (fault)
            std::rethrow_exception(fault);
    }
}

/// Calls read(rows, i) for each of the data's ranges, i, with data that stands before it. Leaves
/// `data` behind the last one.
template <class Data, class Read>
void for_each_range(Data& data, const std::vector<RowRange>& ranges, const Read& read)
{
    std::vector<Data> rows;
    for (const RowRange& range : ranges)
        rows.push_back(data.at(range));
    for_each_in_order(ranges.size(), [&](std::size_t i) { read(rows[i], i); });
    data = std::move(rows.back());
}

}  // namespace surfelao::table
