/// gpu_masks.h: the mask engine on the GPU.
///
/// The tree, the opening rule for groups of sixteen receivers, the raster, the filling of cracks
/// and the sums of tree/masks/masks.h, falloff as the mean over eight limits included; but each
/// receiver walks for itself, once per half a face of its cube, where the CPU's larger groups share
/// what is far. So the same quality draws slightly different nodes: answers differ by no more than
/// the setting's own error (tests say how much), and with `exact` only by single bits at edges.
#pragma once

#include "gpu/context.h"
#include "tree/masks/masks.h"

#include <span>
#include <vector>

namespace surfelao {

/// As solve_masks; options.kernel is without effect. The context must be current. Throws
/// std::runtime_error when the device cannot hold the tree or is lost, Cancelled.
[[nodiscard]] std::vector<Occlusion> solve_masks_gpu(const GlContext& context, const MaskTree& tree,
                                                     std::span<const Receiver> receivers,
                                                     const MaskOptions& options,
                                                     const Progress& progress = {});

}  // namespace surfelao
