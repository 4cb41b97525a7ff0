#include "surfels/progress.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace surfelao {
namespace {

using Clock = std::chrono::steady_clock;

/// By the clock, not by units: where each of them is slow, a wish to stop is heard all the same.
constexpr Clock::duration kBetweenReports = std::chrono::milliseconds(20);

}  // namespace

ProgressMeter::ProgressMeter(const Progress& progress, std::uint64_t total)
    : progress_(progress), total_(total)
{
}

void ProgressMeter::add(std::uint64_t units)
{
    if (stopped_.load(std::memory_order_relaxed))
        throw Cancelled();
    const std::uint64_t done = done_.fetch_add(units, std::memory_order_relaxed) + units;
    if (!progress_)
        return;
    const bool at_end = done >= total_;
    const Clock::rep now = Clock::now().time_since_epoch().count();
    if (!at_end && now < next_report_.load(std::memory_order_relaxed))
        return;

    // one reporter at a time; whoever finds the door closed has nothing newer to say, but the last
    std::unique_lock lock(mutex_, std::defer_lock);
    if (at_end)
        lock.lock();
    else if (!lock.try_lock())
        return;
    const double share = total_ > 0 ? std::min(1.0, static_cast<double>(done) / total_) : 1.0;
    reported_ = std::max(reported_, share);
    next_report_.store(now + kBetweenReports.count(), std::memory_order_relaxed);
    if (!progress_(reported_)) {
        stopped_.store(true, std::memory_order_relaxed);
        throw Cancelled();
    }
}

}  // namespace surfelao
