/// device_solution.h: answers that stay on the GPU, for whoever draws them there.
#pragma once

#include "engines/engine.h"
#include "gpu/objects.h"

#include <cstddef>
#include <optional>
#include <span>

namespace surfelao {

/// It belongs to the context that was prepared for (EngineChoice::context), and may be used in
/// every context that shares objects with it: gpu/objects.h says how. Not needed for it: the
/// Prepared.
struct DeviceSolution {
    TextureBuffer answers;  ///< RGBA32F, a texel per receiver: bent normal xyz | occlusion
    std::size_t count = 0;  ///< of receivers; where there are none, one texel lies there unset
    double seconds = 0.0;
    std::optional<double> residual;  ///< as in Solution
};

/// The same as solve(), to the byte, without the way back. All is done on the device when it
/// returns, so another context sees it. The Prepared must be one of Device::gpu: throws
/// SettingsError if not, and what solve() throws.
[[nodiscard]] DeviceSolution solve_on_device(const Prepared& prepared,
                                             std::span<const Receiver> receivers,
                                             const SolveSettings& settings = {},
                                             const Progress& progress = {});

}  // namespace surfelao
