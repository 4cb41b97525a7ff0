#include "image/legend.h"

#include "image/lettering.h"
#include "surfels/errors.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace surfelao {
namespace {

constexpr int kRowsAScale = 300;  // font pixels are one pixel more for each of these rows
constexpr int kLeastBar = 120;    // font pixels

void fill(Image& image, glm::ivec2 low, glm::ivec2 high, glm::vec4 color)
{
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            image.at(x, y) = color;
}

}  // namespace

std::string legend_number(float value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", static_cast<double>(value));
    return text;
}

void draw_legend(Image& image, const Legend& legend)
{
    SURFELAO_CHECK(legend.low < legend.high);
    // all lengths in font pixels, scaled up for tall pictures
    const int columns = std::max({text_width(legend.title), text_width(legend.note), kLeastBar});
    const int wanted = std::max(1, image.height / kRowsAScale);
    const int scale = std::clamp(image.width / (columns + 24), 1, wanted);
    const int margin = 6 * scale;
    const int bar_width = columns * scale;
    const int bar_height = 10 * scale;
    const int line = (kGlyphHeight + 2) * scale;
    const int lines = legend.note.empty() ? 2 : 3;
    const glm::ivec2 size(bar_width + 2 * margin,
                          bar_height + lines * line + 2 * margin - 2 * scale);
    const glm::ivec2 plate(margin, image.height - margin - size.y);
    if (plate.y < 0 || plate.x + size.x > image.width)
        return;

    const glm::vec4 ink(0.8f, 0.8f, 0.8f, 1.0f);
    fill(image, plate, plate + size, glm::vec4(0.008f, 0.008f, 0.010f, 1.0f));
    glm::ivec2 pen = plate + glm::ivec2(margin);
    draw_text(image, pen, legend.title, ink, scale);
    pen.y += line;
    for (int x = 0; x < bar_width; ++x) {
        const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(bar_width);
        fill(image, pen + glm::ivec2(x, 0), pen + glm::ivec2(x + 1, bar_height),
             glm::vec4(map_color(legend.colors, share), 1.0f));
    }
    pen.y += bar_height + 2 * scale;
    for (float share : {0.0f, 0.5f, 1.0f}) {
        const std::string text = legend_number(glm::mix(legend.low, legend.high, share));
        const int room = bar_width - (text_width(text) - 1) * scale;
        draw_text(image, pen + glm::ivec2(static_cast<int>(share * static_cast<float>(room)), 0),
                  text, ink, scale);
    }
    draw_text(image, pen + glm::ivec2(0, line), legend.note, ink, scale);
}

}  // namespace surfelao
