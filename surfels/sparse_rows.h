/// sparse_rows.h: a sparse matrix of rows with equally many entries, over a few of many columns:
/// what samples fetch of the texels of a map.
///
/// Internal: for the folders' own sources.
#pragma once

#include "surfels/buckets.h"
#include "surfels/for_all.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Products take all cores and add in the entries' order, whatever the number of threads.
template <std::size_t kEntries>
class SparseRows {
public:
    struct Entry {
        std::uint64_t column = 0;
        double weight = 0.0;
    };

    /// entries: row by row. Their columns are below column_count. O(entries), and a few bits for
    /// each column.
    SparseRows(std::span<const Entry> entries, std::uint64_t column_count)
        : places_(entries.size()), weights_(entries.size())
    {
        const Ranks ranks(entries, column_count);
        columns_ = ranks.list();
        for_all(entries.size(), [&](std::size_t i) {
            places_[i] = ranks.place_of(entries[i].column);
            weights_[i] = entries[i].weight;
        });
        by_column_.emplace(columns_.size(), [&](const auto& put) {
            for (std::size_t i = 0; i < places_.size(); ++i)
                put(places_[i], static_cast<std::uint32_t>(i));
        });
    }

    /// Those that occur, rising: the vectors below have a number for each of them.
    [[nodiscard]] const std::vector<std::uint64_t>& columns() const { return columns_; }
    [[nodiscard]] std::size_t row_count() const { return places_.size() / kEntries; }

    /// One number per row.
    [[nodiscard]] std::vector<double> times(const std::vector<double>& of_columns) const
    {
        std::vector<double> of_rows(row_count());
        for_all(of_rows.size(), [&](std::size_t row) {
            double sum = 0.0;
            for (std::size_t i = kEntries * row; i < kEntries * (row + 1); ++i)
                sum += weights_[i] * of_columns[places_[i]];
            of_rows[row] = sum;
        });
        return of_rows;
    }

    /// One number per column.
    [[nodiscard]] std::vector<double> transposed_times(const std::vector<double>& of_rows) const
    {
        std::vector<double> of_columns(columns_.size());
        for_all(of_columns.size(), [&](std::size_t column) {
            double sum = 0.0;
            for (const std::uint32_t i : (*by_column_)[column])
                sum += weights_[i] * of_rows[i / kEntries];
            of_columns[column] = sum;
        });
        return of_columns;
    }

    /// One number per column: of its entries squared, each times what its row has.
    [[nodiscard]] std::vector<double> squares(const std::vector<double>& of_rows) const
    {
        std::vector<double> of_columns(columns_.size());
        for_all(of_columns.size(), [&](std::size_t column) {
            double sum = 0.0;
            for (const std::uint32_t i : (*by_column_)[column])
                sum += weights_[i] * weights_[i] * of_rows[i / kEntries];
            of_columns[column] = sum;
        });
        return of_columns;
    }

private:
    /// Which columns occur, and how many of them before each.
    class Ranks {
    public:
        Ranks(std::span<const Entry> entries, std::uint64_t column_count)
            : words_(column_count / kBits + 1), before_(words_.size())
        {
            for (const Entry& entry : entries)
                words_[entry.column / kBits] |= std::uint64_t{1} << entry.column % kBits;
            for (std::size_t w = 1; w < words_.size(); ++w)
                before_[w] = before_[w - 1] + count(words_[w - 1]);
        }
        [[nodiscard]] std::uint32_t place_of(std::uint64_t column) const
        {
            const std::uint64_t lower = (std::uint64_t{1} << column % kBits) - 1;
            return before_[column / kBits] + count(words_[column / kBits] & lower);
        }
        [[nodiscard]] std::vector<std::uint64_t> list() const
        {
            std::vector<std::uint64_t> columns;
            columns.reserve(before_.back() + count(words_.back()));
            for (std::size_t w = 0; w < words_.size(); ++w) {
                for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1)
                    columns.push_back(kBits * w + static_cast<unsigned>(std::countr_zero(rest)));
            }
            return columns;
        }

    private:
        static constexpr unsigned kBits = 64;
        static std::uint32_t count(std::uint64_t word)
        {
            return static_cast<std::uint32_t>(std::popcount(word));
        }
        std::vector<std::uint64_t> words_;
        std::vector<std::uint32_t> before_;
    };

    std::vector<std::uint64_t> columns_;
    std::vector<std::uint32_t> places_;  ///< per entry, of columns_
    std::vector<double> weights_;
    std::optional<Buckets<std::uint32_t>> by_column_;  ///< numbers of entries
};

}  // namespace surfelao
