/// bit_mask.h: which cells of a grid are taken, a bit each.
///
/// Internal: for packing.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Row by row, 64 cells a word; unused bits of a row's last word are 0.
class BitMask {
public:
    BitMask() = default;
    BitMask(std::uint32_t width, std::uint32_t height);

    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    [[nodiscard]] std::span<const std::uint64_t> row(std::uint32_t y) const
    {
        return {words_.data() + std::size_t{y} * row_words_, row_words_};
    }
    [[nodiscard]] bool at(std::uint32_t x, std::uint32_t y) const
    {
        return (row(y)[x / 64] >> (x % 64) & 1) != 0;
    }
    [[nodiscard]] std::uint64_t count() const;

    /// Cells begin <= x < end of a row; end <= width.
    void set(std::uint32_t y, std::uint32_t begin, std::uint32_t end);

    /// Takes what the other takes, moved to (x, y); all of it must lie inside.
    void stamp(const BitMask& other, std::uint32_t x, std::uint32_t y);
    [[nodiscard]] bool meets(const BitMask& other, std::uint32_t x, std::uint32_t y) const;

    /// What is within `radius` cells in both directions, over a grid wider by that on each side.
    [[nodiscard]] BitMask dilated(std::uint32_t radius) const;
    /// Turned by a quarter: (x, y) goes to (height - 1 - y, x).
    [[nodiscard]] BitMask turned() const;
    /// Blocks of side * side cells as one, taken where any of them is.
    [[nodiscard]] BitMask coarser(std::uint32_t side) const;

private:
    [[nodiscard]] std::span<std::uint64_t> words_of(std::uint32_t y)
    {
        return {words_.data() + std::size_t{y} * row_words_, row_words_};
    }

    std::uint32_t width_ = 0, height_ = 0;
    std::size_t row_words_ = 0;
    std::vector<std::uint64_t> words_;
};

/// A run of cells in a row.
struct CellRun {
    std::uint32_t begin = 0, length = 0;
};

/// The longest run of cells below `width` that are taken, or that are not; the first of several.
[[nodiscard]] CellRun longest_run(std::span<const std::uint64_t> row, std::uint32_t width,
                                  bool taken);

/// Makes `row` tell of each cell whether any of the `length` cells from it on was taken.
void smear_down(std::span<std::uint64_t> row, std::uint32_t length);

/// Moves cell x to x - distance.
void shift_down(std::span<std::uint64_t> row, std::uint32_t distance);

}  // namespace surfelao
