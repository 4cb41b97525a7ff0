/// rows.h: long arrays that can be drawn into: textures of rows of 4,096 texels
/// (shaders/rows.glsl).
#pragma once

#include "gpu/objects.h"

#include <cstdint>
#include <vector>

namespace surfelao {

inline constexpr int kRowTexels = 4096;

/// Texels in as many whole rows as `count` values need; at least one row.
[[nodiscard]] std::uint64_t padded_to_rows(std::uint64_t count);

/// A target of that many values, one colour per format. Throws std::runtime_error naming both
/// numbers when the device does not take so many.
[[nodiscard]] Framebuffer make_rows(const GlContext& context, std::uint64_t count,
                                    const std::vector<TexelFormat>& formats);

}  // namespace surfelao
