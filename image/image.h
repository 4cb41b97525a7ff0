/// image.h: a picture in memory, and the way between linear light and the numbers on a screen.
#pragma once

#include "surfels/srgb.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace surfelao {

/// Linear light with Rec. 709 primaries, straight (not premultiplied) alpha; row 0 is the top.
/// Invariant: pixels.size() == width * height. Default: no pixels.
struct Image {
    Image() = default;
    Image(int columns, int rows, glm::vec4 fill = glm::vec4(0.0f));

    int width = 0;
    int height = 0;
    std::vector<glm::vec4> pixels;

    glm::vec4& at(int x, int y) { return pixels[index(x, y)]; }
    const glm::vec4& at(int x, int y) const { return pixels[index(x, y)]; }

private:
    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

/// Linear interpolation between the four pixels around uv, which runs from (0, 0), the top left
/// corner of the top left pixel, to (1, 1). Left and right edge meet (for panoramas); top and
/// bottom are repeated. The image must have pixels.
[[nodiscard]] glm::vec4 sample_panorama(const Image& image, glm::vec2 uv);

}  // namespace surfelao
