/// stopwatch.h: seconds of a run.
#pragma once

#include <chrono>

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

}  // namespace surfelao
