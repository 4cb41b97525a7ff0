/// gpu_masks.h: the mask engine on the GPU.
///
/// The tree, the opening rule for groups of sixteen receivers, the raster, the filling of cracks
/// and the sums of tree/masks/masks.h, falloff as the mean over several limits included; but each
/// receiver walks for itself, once per half a face of its cube, where the CPU's larger groups share
/// what is far. So the same quality draws slightly different nodes: answers differ by no more than
/// the setting's own error (tests say how much), and with `exact` only by single bits at edges.
#pragma once

#include "gpu/objects.h"
#include "tree/masks/masks.h"

#include <memory>
#include <span>

namespace surfelao {

/// A tree on the device, to be asked any number of times. It belongs to its context as all that
/// lives there does (objects.h).
class GpuMasks {
public:
    /// O(n). The tree is not needed any more. The context must be current. Throws
    /// std::runtime_error when the device cannot hold the tree.
    GpuMasks(const GlContext& context, const MaskTree& tree);
    ~GpuMasks();
    GpuMasks(GpuMasks&&) noexcept;
    GpuMasks& operator=(GpuMasks&&) noexcept;

    /// As solve_masks, one texel per receiver (answers.h); options.kernel is without effect.
    /// Everything is drawn when it returns. The context must be current. Throws SettingsError where
    /// an option is out of its range, std::runtime_error when the device cannot hold the receivers
    /// or is lost, Cancelled.
    [[nodiscard]] TextureBuffer solve(std::span<const Receiver> receivers,
                                      const MaskOptions& options,
                                      const Progress& progress = {}) const;

    struct Impl;  ///< for gpu_masks.cpp alone

private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace surfelao
