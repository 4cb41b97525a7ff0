/// row_ranges.h: rows of numbers, read by all threads: where ranges of them begin. Internal to the
/// readers of rows.
#pragma once

#include "files/text_cursor.h"

#include <tbb/parallel_for.h>

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

/// Ranges of about kRangeBytes that make up the next `count` lines with a word; the last one goes
/// up to `count` where the text ends before. O(bytes that remain), all threads.
[[nodiscard]] std::vector<RowRange> row_ranges(const TextCursor& cursor, std::uint64_t count);

/// The same of rows of equal size in `bytes` of data that remain from `offset` on. O(ranges).
[[nodiscard]] std::vector<RowRange> row_ranges(std::size_t offset, std::size_t bytes,
                                               std::size_t row_bytes, std::uint64_t count);

/// What a thread takes at once: large enough that starting it costs nothing beside.
inline constexpr std::size_t kRangeBytes = std::size_t{1} << 18;

/// Calls read(rows, i) for each of the data's ranges, i, with data that stands before it; all
/// threads. Leaves `data` behind the last one. Where several throw, the first in the file's order
/// is heard.
template <class Data, class Read>
void for_each_range(Data& data, const std::vector<RowRange>& ranges, const Read& read)
{
    std::vector<Data> rows;
    for (const RowRange& range : ranges)
        rows.push_back(data.at(range));
    std::vector<std::exception_ptr> faults(ranges.size());
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t i) {
        try {
            read(rows[i], i);
        } catch (...) {
            faults[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& fault : faults) {
        if (fault)
            std::rethrow_exception(fault);
    }
    data = std::move(rows.back());
}

}  // namespace surfelao::table
