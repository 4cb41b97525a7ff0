/// calls.h: work of seconds or minutes, asked for from Python.
///
/// It runs in a thread of its own, on all cores, without the interpreter's lock. The thread that
/// asked waits, and looks every kLook for signals and tells its listener how far the work is. So
/// Ctrl-C and a listener's "stop" end any call at once, whatever the work is at: the work itself
/// ends at its next report, a moment later, and nobody sees its result.
#pragma once

#include "bake/error_search.h"

#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace surfelao {

inline constexpr std::chrono::milliseconds kLook{20};

/// Runs it to its end. work: owns what it uses, and nothing of Python. listener: None, or called as
/// listener(stage, done) in this thread; what it returns stops the work where it is False, what it
/// raises does too. threads: a limit (ThreadLimit). With the lock held; throws what the work
/// throws, Cancelled, and error_already_set for what signals and listeners raise.
void run_call(std::function<void(const StageProgress&)> work, const pybind11::object& listener,
              std::optional<int> threads);

/// The same for work that has a result.
template <class Work>
auto result_of(Work work, const pybind11::object& listener, std::optional<int> threads)
{
    using Result = decltype(work(StageProgress()));
    const auto result = std::make_shared<std::optional<Result>>();
    run_call([work = std::move(work),
              result](const StageProgress& progress) { result->emplace(work(progress)); },
             listener, threads);
    return std::make_shared<Result>(std::move(**result));
}

/// Stops all calls, refuses new ones and waits for their threads: before the interpreter ends.
void end_calls();

}  // namespace surfelao
