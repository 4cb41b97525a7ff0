/// buckets.h: things sorted by a small number each of them has, as one array with offsets.
///
/// Internal: for the folders' own sources.
#pragma once

#include "surfels/owner_ranges.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace surfelao {

/// Items by their owner, each owner's in the order in which they were put. Fewer than 2^32 items.
template <class Item>
class Buckets {
    static_assert(std::is_trivially_copyable_v<Item>);

public:
    /// for_each(put) calls put(owner, item) for every item, the same ones each time; each thread
    /// calls it twice, to count and to fill. Owners are below owner_count. O(owners + items).
    template <class ForEach>
    Buckets(std::size_t owner_count, const ForEach& for_each) : first_(owner_count + 2, 0)
    {
        // first_[owner + 1] is where the owner's next item goes, and in the end where they end
        for_owner_ranges(owner_count, [&](OwnerRange range) {
            for_each([&](std::uint32_t owner, const Item&) {
                if (range.has(owner))
                    ++first_[owner + 2];
            });
        });
        for (std::size_t i = 2; i < first_.size(); ++i)
            first_[i] += first_[i - 1];
        items_ = std::make_unique_for_overwrite<Item[]>(first_.back());
        for_owner_ranges(owner_count, [&](OwnerRange range) {
            for_each([&](std::uint32_t owner, const Item& item) {
                if (range.has(owner))
                    items_[first_[owner + 1]++] = item;
            });
        });
    }

    [[nodiscard]] std::size_t owner_count() const { return first_.size() - 2; }
    [[nodiscard]] std::span<const Item> operator[](std::size_t owner) const
    {
        return {items_.get() + first_[owner], first_[owner + 1] - first_[owner]};
    }

private:
    std::vector<std::uint32_t> first_;
    std::unique_ptr<Item[]> items_;
};

/// Calls visit(items) for each run of items that are alike.
template <class Item, class Alike, class Visit>
void for_each_run(std::span<Item> items, const Alike& alike, const Visit& visit)
{
    for (std::size_t begin = 0; begin < items.size();) {
        std::size_t end = begin + 1;
        while (end < items.size() && alike(items[begin], items[end]))
            ++end;
        visit(items.subspan(begin, end - begin));
        begin = end;
    }
}

}  // namespace surfelao
