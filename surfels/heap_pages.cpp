#include "surfels/heap_pages.h"

#include <cstdlib>  // says which C library this is

#if defined(__GLIBC__)
#include "surfels/large_pages.h"

#include <malloc.h>
#include <unistd.h>
#endif

namespace surfelao {
namespace {

#if defined(__GLIBC__)
/// In bytes. Larger arrays are pages of their own, which go back to the system; left alone, the
/// bound starts at 128 KiB and moves as arrays come and go, to 32 MiB at most. spare: address space
/// at the heap's end, taken at once and kept.
void set_bounds(int array, int spare)
{
    mallopt(M_MMAP_THRESHOLD, array);
    mallopt(M_TOP_PAD, spare);
    mallopt(M_TRIM_THRESHOLD, spare + array);
}
#endif

}  // namespace

void keep_heap_pages()
{
#if defined(__GLIBC__)
    constexpr int kArray = 32 << 20, kSpare = 256 << 20;
    set_bounds(kArray, kSpare);
    char* const begin = static_cast<char*>(sbrk(0));
    void* volatile array = std::malloc(kArray / 2);  // the heap has to grow
    std::free(array);
    prefer_large_pages(begin, static_cast<char*>(sbrk(0)));
#endif
}

void return_heap_pages()
{
#if defined(__GLIBC__)
    set_bounds(1 << 20, 0);
#endif
}

}  // namespace surfelao
