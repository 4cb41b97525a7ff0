#include "surfels/for_all.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

namespace surfelao {

void for_ranges(std::size_t begin, std::size_t end, std::size_t grain, const RangeBody& body)
{
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(begin, end, grain),
                      [&](const Range& range) { body(range.begin(), range.end()); });
}

void do_both(const RangeBody& body)
{
    tbb::parallel_invoke([&] { body(0, 1); }, [&] { body(1, 2); });
}

std::size_t loop_threads()
{
    return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
}

}  // namespace surfelao
