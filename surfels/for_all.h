/// for_all.h: a loop on all threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace surfelao {

/// body(i) for 0 to count - 1, in any order, on all threads.
template <class Body>
void for_all(std::size_t count, const Body& body)
{
    constexpr std::size_t kGrain = 4096;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              body(i);
                      });
}

}  // namespace surfelao
