#include "surfels/freed_pages.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace surfelao {

void keep_freed_pages([[maybe_unused]] bool large)
{
#if defined(__GLIBC__)
    // larger arrays are pages of their own, which go back to the system; left alone, the bound
    // starts at 128 KiB and moves as arrays come and go, to 32 MiB at most
    const int bytes = (large ? 32 : 1) << 20;
    mallopt(M_MMAP_THRESHOLD, bytes);
    mallopt(M_TRIM_THRESHOLD, bytes);
#endif
}

}  // namespace surfelao
