/// discard.h: large arrays that are used up from one end to the other give back what is behind.
#pragma once

#include "surfels/large_pages.h"

#include <cstddef>
#include <cstdint>
#include <span>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace surfelao {

/// The system may take the memory of the elements, by the large page: nobody reads them again. What
/// is built of them then takes their place instead of standing beside them. Any number of threads
/// at once, each for elements of its own.
template <class T>
void discard(std::span<T> elements)
{
#if defined(MADV_DONTNEED)
    if (elements.size_bytes() < kLargePage)
        return;
    const auto up = [](T* at) {
        return (reinterpret_cast<std::uintptr_t>(at) + kLargePage - 1) / kLargePage;
    };
    const std::uintptr_t first = up(elements.data());
    const std::uintptr_t last =
        reinterpret_cast<std::uintptr_t>(elements.data() + elements.size()) / kLargePage;
    if (first < last)  // where the system does not want it, it stays
        static_cast<void>(madvise(reinterpret_cast<void*>(first * kLargePage),
                                  (last - first) * kLargePage, MADV_DONTNEED));
#else
    static_cast<void>(elements);
#endif
}

}  // namespace surfelao
