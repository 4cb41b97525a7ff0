#include "surfels/progress.h"

#include <algorithm>
#include <utility>

namespace surfelao {

ProgressMeter::ProgressMeter(const Progress& progress, std::uint64_t total)
    : progress_(progress), total_(total)
{
}

void ProgressMeter::add(std::uint64_t units)
{
    if (stopped_.load(std::memory_order_relaxed))
        throw Cancelled();
    const std::uint64_t done = done_.fetch_add(units, std::memory_order_relaxed) + units;
    if (!progress_ || done < next_report_.load(std::memory_order_relaxed))
        return;

    // one reporter at a time; whoever finds the door closed has nothing newer to say
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock)
        return;
    const double share = total_ > 0 ? std::min(1.0, static_cast<double>(done) / total_) : 1.0;
    reported_ = std::max(reported_, share);
    next_report_.store(done + std::max<std::uint64_t>(1, total_ / 1000), std::memory_order_relaxed);
    if (!progress_(reported_)) {
        stopped_.store(true, std::memory_order_relaxed);
        throw Cancelled();
    }
}

}  // namespace surfelao
