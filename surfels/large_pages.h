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
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace surfelao {

/// In bytes.
inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// At the start of a page; std::free() takes it back. Null where there is no memory.
[[nodiscard]] inline void* allocate_large_pages(std::size_t bytes)
{
    void* memory = nullptr;
    if (posix_memalign(&memory, kLargePage, bytes) != 0)
        return nullptr;
#if defined(MADV_HUGEPAGE)
    static_cast<void>(madvise(memory, bytes / kLargePage * kLargePage, MADV_HUGEPAGE));
#endif
    return memory;
}

}  // namespace surfelao
