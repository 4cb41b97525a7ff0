/// raw_vector.h: a std::vector for large arrays that are about to be filled in by all threads.
///
/// resize() leaves new elements unset instead of writing zeros first on one thread, which takes as
/// long as the filling. Each must be written before it is read. For trivial types only.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace surfelao {

template <class T>
struct RawAllocator : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    template <class U>
    struct rebind {
        using other = RawAllocator<U>;
    };

    RawAllocator() = default;
    template <class U>
    RawAllocator(const RawAllocator<U>&)
    {
    }

    template <class U, class... Arguments>
    void construct(U* at, Arguments&&... arguments)
    {
        if constexpr (sizeof...(Arguments) > 0)
            std::construct_at(at, std::forward<Arguments>(arguments)...);
        else
            ::new (static_cast<void*>(at)) U;
    }
};

template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace surfelao
