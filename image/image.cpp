#include "image/image.h"

#include "surfels/errors.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {

Image::Image(int columns, int rows, glm::vec4 fill) : width(columns), height(rows)
{
    SURFELAO_CHECK(columns >= 0 && rows >= 0);
    pixels.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), fill);
}

glm::vec4 sample_panorama(const Image& image, glm::vec2 uv)
{
    SURFELAO_CHECK(!image.pixels.empty());
    const float x = uv.x * static_cast<float>(image.width) - 0.5f;
    const float y = uv.y * static_cast<float>(image.height) - 0.5f;
    const float left = std::floor(x);
    const float top = std::floor(y);

    const auto pixel = [&](float column, float row) {
        const int wrapped = static_cast<int>(column) % image.width;
        return image.at(wrapped < 0 ? wrapped + image.width : wrapped,
                        std::clamp(static_cast<int>(row), 0, image.height - 1));
    };
    return glm::mix(glm::mix(pixel(left, top), pixel(left + 1.0f, top), x - left),
                    glm::mix(pixel(left, top + 1.0f), pixel(left + 1.0f, top + 1.0f), x - left),
                    y - top);
}

}  // namespace surfelao
