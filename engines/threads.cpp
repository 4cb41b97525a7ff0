#include "engines/threads.h"

#include "surfels/errors.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <thread>

namespace surfelao {

struct ThreadLimit::Impl {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
{
    require(threads >= 1, "threads must be at least 1");
    impl_.reset(new Impl{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                             static_cast<std::size_t>(threads))});
}

ThreadLimit::~ThreadLimit() = default;

int thread_count()
{
    const std::size_t allowed =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    return static_cast<int>(std::min(allowed, cores));
}

}  // namespace surfelao
