#include "atlas/bit_mask.h"

#include <algorithm>
#include <bit>

namespace surfelao {
namespace {

constexpr std::uint32_t kWordBits = 64;
constexpr std::uint64_t kAllOnes = ~std::uint64_t{0};

/// to |= from moved by `distance` cells up.
void merge_moved_up(std::span<const std::uint64_t> from, std::uint32_t distance,
                    std::span<std::uint64_t> to)
{
    const std::size_t words = distance / kWordBits;
    const std::uint32_t bits = distance % kWordBits;
    for (std::size_t i = 0; i < from.size() && i + words < to.size(); ++i) {
        to[i + words] |= from[i] << bits;
        if (bits != 0 && i + words + 1 < to.size())
            to[i + words + 1] |= from[i] >> (kWordBits - bits);
    }
}

}  // namespace

BitMask::BitMask(std::uint32_t width, std::uint32_t height)
    : width_(width),
      height_(height),
      row_words_((width + kWordBits - 1) / kWordBits),
      words_(row_words_ * height, 0)
{
}

std::uint64_t BitMask::count() const
{
    std::uint64_t sum = 0;
    for (const std::uint64_t word : words_)
        sum += static_cast<std::uint64_t>(std::popcount(word));
    return sum;
}

void BitMask::set(std::uint32_t y, std::uint32_t begin, std::uint32_t end)
{
    if (begin >= end)
        return;
    const std::span<std::uint64_t> words = words_of(y);
    const std::size_t first = begin / kWordBits, last = (end - 1) / kWordBits;
    for (std::size_t i = first; i <= last; ++i) {
        std::uint64_t word = kAllOnes;
        if (i == first)
            word &= kAllOnes << (begin % kWordBits);
        if (i == last)
            word &= kAllOnes >> (kWordBits - 1 - (end - 1) % kWordBits);
        words[i] |= word;
    }
}

void BitMask::stamp(const BitMask& other, std::uint32_t x, std::uint32_t y)
{
    for (std::uint32_t r = 0; r < other.height_; ++r)
        merge_moved_up(other.row(r), x, words_of(y + r));
}

bool BitMask::meets(const BitMask& other, std::uint32_t x, std::uint32_t y) const
{
    const std::size_t words = x / kWordBits;
    const std::uint32_t bits = x % kWordBits;
    for (std::uint32_t r = 0; r < other.height_; ++r) {
        const std::span<const std::uint64_t> own = row(y + r), others = other.row(r);
        std::uint64_t carried = 0;
        std::size_t i = words;
        for (const std::uint64_t word : others) {
            if (((word << bits | carried) & own[i++]) != 0)
                return true;
            carried = bits != 0 ? word >> (kWordBits - bits) : 0;
        }
        if (carried != 0 && (carried & own[i]) != 0)
            return true;
    }
    return false;
}

BitMask BitMask::dilated(std::uint32_t radius) const
{
    const std::uint32_t span = 2 * radius + 1;
    BitMask result(width_ + 2 * radius, height_ + 2 * radius);
    std::vector<std::uint64_t> moved(result.row_words_);
    // along rows, and each row once where it ends up lowest
    for (std::uint32_t y = 0; y < height_; ++y) {
        const std::span<std::uint64_t> wide = result.words_of(y);
        merge_moved_up(row(y), 0, wide);
        for (std::uint32_t done = 1; done < span;) {
            const std::uint32_t step = std::min(done, span - done);
            moved.assign(wide.begin(), wide.end());
            merge_moved_up(moved, step, wide);
            done += step;
        }
    }
    // down columns, from the last row on, so that no row is read after it was changed
    for (std::uint32_t done = 1; done < span;) {
        const std::uint32_t step = std::min(done, span - done);
        for (std::uint32_t y = result.height_ - 1; y >= step; --y)
            merge_moved_up(result.row(y - step), 0, result.words_of(y));
        done += step;
    }
    return result;
}

BitMask BitMask::turned() const
{
    BitMask result(height_, width_);
    for (std::uint32_t y = 0; y < height_; ++y) {
        const std::uint32_t column = height_ - 1 - y;
        const std::span<const std::uint64_t> words = row(y);
        for (std::size_t i = 0; i < words.size(); ++i) {
            for (std::uint64_t word = words[i]; word != 0; word &= word - 1) {
                const auto x = static_cast<std::uint32_t>(i * kWordBits) +
                               static_cast<std::uint32_t>(std::countr_zero(word));
                result.words_of(x)[column / kWordBits] |= std::uint64_t{1} << (column % kWordBits);
            }
        }
    }
    return result;
}

BitMask BitMask::coarser(std::uint32_t side) const
{
    BitMask result((width_ + side - 1) / side, (height_ + side - 1) / side);
    for (std::uint32_t y = 0; y < height_; ++y) {
        const std::span<const std::uint64_t> words = row(y);
        for (std::size_t i = 0; i < words.size(); ++i) {
            std::uint64_t word = words[i];
            while (word != 0) {
                const auto x = static_cast<std::uint32_t>(i * kWordBits) +
                               static_cast<std::uint32_t>(std::countr_zero(word));
                const std::uint32_t cell = x / side;
                result.set(y / side, cell, cell + 1);
                const std::uint64_t next = (std::uint64_t{cell} + 1) * side - i * kWordBits;
                word = next < kWordBits ? word & kAllOnes << next : 0;
            }
        }
    }
    return result;
}

CellRun longest_run(std::span<const std::uint64_t> row, std::uint32_t width, bool taken)
{
    CellRun best, run;
    for (std::uint32_t x = 0; x < width;) {
        const std::uint32_t bit = x % kWordBits;
        const std::uint64_t word = (taken ? row[x / kWordBits] : ~row[x / kWordBits]) >> bit;
        const std::uint32_t rest = std::min(kWordBits - bit, width - x);
        if ((word & 1) != 0) {
            const std::uint32_t ones =
                std::min(rest, static_cast<std::uint32_t>(std::countr_one(word)));
            if (run.length == 0)
                run.begin = x;
            run.length += ones;
            x += ones;
            if (run.length > best.length)
                best = run;
        } else {
            run.length = 0;
            x += std::min(rest, static_cast<std::uint32_t>(std::countr_zero(word)));
        }
    }
    return best;
}

void shift_down(std::span<std::uint64_t> row, std::uint32_t distance)
{
    const std::size_t words = distance / kWordBits;
    const std::uint32_t bits = distance % kWordBits;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const std::uint64_t low = i + words < row.size() ? row[i + words] : 0;
        const std::uint64_t high = i + words + 1 < row.size() ? row[i + words + 1] : 0;
        row[i] = bits == 0 ? low : low >> bits | high << (kWordBits - bits);
    }
}

void smear_down(std::span<std::uint64_t> row, std::uint32_t length)
{
    for (std::uint32_t done = 1; done < length;) {
        const std::uint32_t step = std::min(done, length - done);
        const std::size_t words = step / kWordBits;
        const std::uint32_t bits = step % kWordBits;
        // rising, so that what is read was not changed in this pass
        for (std::size_t i = 0; i + words < row.size(); ++i) {
            const std::uint64_t low = row[i + words];
            const std::uint64_t high = i + words + 1 < row.size() ? row[i + words + 1] : 0;
            row[i] |= bits == 0 ? low : low >> bits | high << (kWordBits - bits);
        }
        done += step;
    }
}

}  // namespace surfelao
