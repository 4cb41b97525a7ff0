/// child_process.h: another program, held to limits, for what it writes. Internal to the folder.
#pragma once

#include "surfels/progress.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace surfelao {

struct ChildLimits {
    std::uint64_t memory = 0;  ///< bytes of its address space
    std::uint64_t output = 0;  ///< bytes that it writes
    std::uint32_t cpu_seconds = 0;
    std::uint32_t seconds = 0;  ///< by the clock
};

/// How a program ended.
struct ChildResult {
    enum class End { exited, killed, out_of_time };
    End end = End::exited;
    int code = 0;        ///< of its exit, or the signal that killed it
    std::string output;  ///< all that it wrote to standard output
    std::string errors;  ///< to standard error, the first kMostErrors bytes
};

inline constexpr std::size_t kMostErrors = 1 << 16;

/// Runs it to its end. Its output lies in memory, no file is made; it dumps no core, reads nothing
/// from standard input, and dies with this process. `progress` is told 0 now and then: the program
/// is killed and Cancelled thrown where it returns false. Throws std::runtime_error where the
/// machine refuses. A program that is not there exits with kNotStarted.
[[nodiscard]] ChildResult run_child(const std::filesystem::path& program,
                                    std::span<const std::string> arguments,
                                    const ChildLimits& limits, const Progress& progress);

inline constexpr int kNotStarted = 127;

}  // namespace surfelao
