/// raw_vector.h: a std::vector for large arrays that are about to be filled in by all threads.
///
/// resize() leaves new elements unset instead of writing zeros first on one thread, which takes as
/// long as the filling. Each must be written before it is read. Large arrays lie in large pages
/// (surfels/large_pages.h). For trivial types only.
#pragma once

#include "surfels/large_pages.h"

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace surfelao {

template <class T>
class RawAllocator {
public:
    using value_type = T;
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    RawAllocator() = default;
    template <class U>
    RawAllocator(const RawAllocator<U>&)
    {
    }

    [[nodiscard]] T* allocate(std::size_t count)
    {
        if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T))
            throw std::bad_array_new_length();
        const std::size_t bytes = count * sizeof(T);
        void* const memory = bytes >= kLargePage / 2
                                 ? allocate_large_pages(up_to(kLargePage, bytes))
                                 : std::aligned_alloc(kLine, up_to(kLine, bytes));
        if (memory == nullptr)
            throw std::bad_alloc();
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t) { std::free(memory); }

    template <class U, class... Arguments>
    void construct(U* at, Arguments&&... arguments)
    {
        if constexpr (sizeof...(Arguments) > 0)
            std::construct_at(at, std::forward<Arguments>(arguments)...);
        else
            ::new (static_cast<void*>(at)) U;
    }

    bool operator==(const RawAllocator&) const { return true; }

private:
    static std::size_t up_to(std::size_t unit, std::size_t bytes)
    {
        return (bytes + unit - 1) / unit * unit;
    }

    static constexpr std::size_t kLine = 64;
    static_assert(alignof(T) <= kLine);
};

template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace surfelao
