/// large_pages.h: memory for large arrays, in the system's large pages.
///
/// Fresh memory is given by the page, on the first touch: with pages of 4 KiB that takes a quarter
/// of the time of building a tree, and a tenth of the processor's of a bake from file to file of
/// ten million triangles. Pages of 2 MiB are asked for where the system leaves that to programs
/// (Linux, transparent_hugepage/enabled = madvise, the usual setting); elsewhere small ones do as
/// well.
///
/// Internal: for the folders' own sources.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace surfelao {

/// In bytes.
inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// Of memory that is not touched yet.
inline void prefer_large_pages([[maybe_unused]] char* begin, [[maybe_unused]] char* end)
{
#if defined(MADV_HUGEPAGE)
    const auto before = reinterpret_cast<std::uintptr_t>(begin) % kLargePage;
    char* const first = before == 0 ? begin : begin + (kLargePage - before);
    if (first + kLargePage <= end)
        static_cast<void>(madvise(
            first, static_cast<std::size_t>(end - first) / kLargePage * kLargePage, MADV_HUGEPAGE));
#endif
}

/// At the start of a page; std::free() takes it back. Null where there is no memory.
[[nodiscard]] inline void* allocate_large_pages(std::size_t bytes)
{
    void* memory = nullptr;
    if (posix_memalign(&memory, kLargePage, bytes) != 0)
        return nullptr;
    prefer_large_pages(static_cast<char*>(memory), static_cast<char*>(memory) + bytes);
    return memory;
}

}  // namespace surfelao
