/// disk_memory.h: occlusion by disks in scenes that move, frame by frame.
///
/// As solve_disks, but for what the first correction starts from. Its sums are linear: what a body
/// hides from its own disks turns with the body and is remembered, and only what the other bodies
/// hide is summed anew; the corrections after it are whole passes. A frame's answer depends
/// on that frame alone, in every bit: what moves away and back gives the first frame's bytes. (The
/// visibility that the last frame ended with, as Bunnell starts from it, would not: it leads to
/// where the passes settle, by another way for every path, and is off by as much as the last pass
/// still changed.)
///
/// Groups of receivers are formed once per body, in its own space.
#pragma once

#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "tree/disks/disk_forest.h"
#include "tree/disks/disks.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

struct DiskFrame {
    std::vector<double> residuals;  ///< as in DiskResult
    std::uint64_t solved = 0;       ///< receivers that were answered
};

class DiskMemory {
public:
    /// body_of_receiver: one per receiver, which stands on its body at rest. Throws SettingsError
    /// where an option is out of its range. options.share is not looked at.
    DiskMemory(const DiskForest& forest, std::span<const Receiver> at_rest,
               std::span<const std::uint32_t> body_of_receiver, const DiskOptions& options);
    ~DiskMemory();
    DiskMemory(DiskMemory&&) noexcept;
    DiskMemory& operator=(DiskMemory&&) noexcept;

    /// at_rest: all receivers; those of the body have changed.
    void deform(std::uint32_t body, std::span<const Receiver> at_rest);

    /// The forest as it is now, of the bodies with which the memory was made. Answers of hidden
    /// bodies are left as they are. Throws Cancelled.
    DiskFrame solve(const DiskForest& forest, std::span<Occlusion> answers,
                    const Progress& progress = {});

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao
