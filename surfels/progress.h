/// progress.h: how long work tells how far it is, and how it is stopped.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>

namespace surfelao {

/// Told the share of the work that is done, 0 to 1, never going back, by one thread at a time, at
/// most fifty times a second and once at the end. Returns false to stop the work. Empty = nobody is
/// listening.
using Progress = std::function<bool(double done)>;

/// Thrown out of any long function whose Progress returned false. Its results are lost, its inputs
/// untouched.
class Cancelled : public std::exception {
public:
    const char* what() const noexcept override { return "cancelled"; }
};

/// Counts finished units from any number of threads and passes them on to a Progress.
class ProgressMeter {
public:
    /// total: number of units in the whole job; 0 is allowed.
    ProgressMeter(const Progress& progress, std::uint64_t total);

    /// Adds finished units. Throws Cancelled in every thread once the listener has said stop.
    void add(std::uint64_t units);

private:
    Progress progress_;
    std::uint64_t total_;
    std::atomic<std::uint64_t> done_{0};
    std::atomic<std::int64_t> next_report_{0};  ///< ticks of the steady clock
    std::atomic<bool> stopped_{false};
    std::mutex mutex_;
    double reported_ = 0.0;
};

}  // namespace surfelao
