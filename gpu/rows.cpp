#include "gpu/rows.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace surfelao {

std::uint64_t padded_to_rows(std::uint64_t count)
{
    const std::uint64_t rows = (count + kRowTexels - 1) / kRowTexels;
    return std::max<std::uint64_t>(1, rows) * kRowTexels;
}

Framebuffer make_rows(const GlContext& context, std::uint64_t count,
                      const std::vector<TexelFormat>& formats)
{
    const std::uint64_t rows = padded_to_rows(count) / kRowTexels;
    const auto limit = static_cast<std::uint64_t>(context.info().max_texture_size);
    if (rows > limit)
        throw std::runtime_error("OpenGL: an array of " + std::to_string(count) +
                                 " values cannot be made; this device takes " +
                                 std::to_string(limit * kRowTexels));
    return Framebuffer(context,
                       {.width = kRowTexels, .height = static_cast<int>(rows), .colors = formats});
}

}  // namespace surfelao
