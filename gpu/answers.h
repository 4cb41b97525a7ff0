/// answers.h: what an engine found, as it lies on the device: RGBA32F, one texel a receiver, in the
/// receivers' order: bent normal xyz | occlusion (surfels/occlusion.h).
#pragma once

#include "gpu/objects.h"
#include "surfels/occlusion.h"

#include <cstddef>
#include <vector>

namespace surfelao {

/// The first `count` texels of a picture in rows (rows.h), which does not leave the device.
[[nodiscard]] TextureBuffer answers_of_rows(const GlContext& context, const Framebuffer& rows,
                                            std::size_t count);

/// The first `count` of them, waiting for the device.
[[nodiscard]] std::vector<Occlusion> read_answers(const TextureBuffer& answers, std::size_t count);

}  // namespace surfelao
