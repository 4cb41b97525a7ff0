/// timing.h: seconds and bytes of a run.
#pragma once

#include <chrono>
#include <cstdint>

namespace surfelao {

/// Starts when it is made.
class Stopwatch {
public:
    /// Seconds since the start or the last lap.
    double lap()
    {
        const Clock::time_point now = Clock::now();
        const std::chrono::duration<double> passed = now - start_;
        start_ = now;
        return passed.count();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// The most memory this process has held at once.
[[nodiscard]] std::uint64_t peak_rss_bytes();

}  // namespace surfelao
