/// gpu_disks.h: the disk engine on the GPU.
///
/// What it measures and how is said in tree/disks/disks.h; this is the same computation, step by
/// step, with all data on the device between its first and its last pass: the octree as one array
/// of records (shaders/disk_record.glsl), groups of sixteen receivers that open the same nodes as
/// on the CPU. What the correcting passes come to is kept for the next solve with the same options,
/// whoever is asked then: one pass is left, with the same answers. Results agree with
/// solve_disks to 1e-4 but where rounding tips the opening of a node (tests say how often).
#pragma once

#include "gpu/objects.h"
#include "tree/disks/disks.h"

#include <memory>
#include <span>
#include <vector>

namespace surfelao {

struct GpuDiskResult {
    TextureBuffer answers;          ///< answers.h
    std::vector<double> residuals;  ///< as in DiskResult
};

/// An octree on the device, to be asked any number of times. It belongs to its context as all that
/// lives there does (objects.h).
class GpuDisks {
public:
    /// O(n). `octree` must outlive it. The context must be current. Throws std::runtime_error when
    /// the device cannot hold the octree.
    GpuDisks(const GlContext& context, const Octree& octree);
    ~GpuDisks();
    GpuDisks(GpuDisks&&) noexcept;
    GpuDisks& operator=(GpuDisks&&) noexcept;

    /// As solve_disks, one texel per receiver; everything is drawn when it returns. The context
    /// must be current. Throws SettingsError where an option is out of its range,
    /// std::runtime_error when the device cannot hold the receivers or is lost, Cancelled.
    [[nodiscard]] GpuDiskResult solve(std::span<const Receiver> receivers,
                                      const DiskOptions& options,
                                      const Progress& progress = {}) const;

    struct Impl;  ///< for gpu_disks.cpp alone

private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace surfelao
