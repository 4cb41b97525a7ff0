// All arrays of the program lie in large pages where they are large: this takes the place of the
// standard library's operator new, for the whole program. A library must leave that to the program
// that it is part of, so that programs alone link this.

#include "surfels/large_pages.h"

#include <cstdlib>
#include <new>

namespace {

// In bytes. Smaller ones come again and again, from memory that is not fresh any more.
constexpr std::size_t kLargeArray = 2 * surfelao::kLargePage;

}  // namespace

void* operator new(std::size_t bytes)
{
    void* const memory = bytes >= kLargeArray ? surfelao::allocate_large_pages(bytes)
                                              : std::malloc(bytes > 0 ? bytes : 1);
    if (memory == nullptr)
        throw std::bad_alloc();
    return memory;
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}
