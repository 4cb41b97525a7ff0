#include "viewer/pane.h"

#include "image/lettering.h"
#include "surfels/srgb.h"
#include "viewer/atlas_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace surfelao {
namespace {

const glm::vec4 kPlate(0.008f, 0.008f, 0.010f, 1.0f), kInk(0.8f, 0.8f, 0.8f, 1.0f);

void fill_rows(Image& image, glm::ivec2 low, glm::ivec2 high, const glm::vec4& color)
{
    for (int y = std::max(0, low.y); y < std::min(high.y, image.height); ++y)
        for (int x = std::max(0, low.x); x < std::min(high.x, image.width); ++x)
            image.at(x, y) = color;
}

/// Its left upper corner.
void draw_label(Image& image, glm::ivec2 corner, const std::string& text, int scale)
{
    const int around = 3 * scale;
    const glm::ivec2 size(text_width(text) * scale, kGlyphHeight * scale);
    fill_rows(image, corner, corner + size + 2 * around, kPlate);
    draw_text(image, corner + around, text, kInk, scale);
}

/// As Panel draws them over the window.
void draw_labels(Image& image, const PaneLabels& labels, float line)
{
    const int scale = std::max(1, image.height / 400);
    const int at = static_cast<int>(std::lround(line * static_cast<float>(image.width)));
    const int margin = 6 * scale;
    const int left_width = (text_width(labels.left) + 6) * scale;
    fill_rows(image, {at, 0}, {at + scale, image.height}, kInk);
    draw_label(image, {at - margin - left_width, margin}, labels.left, scale);
    draw_label(image, {at + margin + scale, margin}, labels.right, scale);
}

}  // namespace

Image flat_map(const Pane& pane, const CellView& cell, const ViewOptions& view)
{
    const SessionState& state = cell.session().state();
    const ModelMap* rays = state.map_reference.get();
    const SurfaceData data{.layout = state.layout.get(),
                           .map = rays && pane.as.wipe == 0.0f ? rays : state.map.get(),
                           .reference = rays,
                           .paint = cell.paint()};
    return atlas_picture(*state.model->mesh, data, view, pane.size().width, pane.size().height);
}

Image picture_of(std::span<const Pane> panes, const PaneLabels& labels, float line)
{
    int right = 0;
    for (const Pane& pane : panes)
        right = std::max(right, pane.as.place.x + pane.as.place.width);
    const Rect& first = panes.front().as.place;
    Image all(right - first.x, first.height);
    for (const Pane& pane : panes) {
        if (pane.sum.count() == 0)
            continue;
        const Image image = pane.sum.mean();
        const int left = pane.as.shown.x - pane.as.place.x;
        for (int y = 0; y < image.height; ++y)
            for (int x = left; x < left + pane.as.shown.width; ++x)
                all.at(pane.as.place.x - first.x + x, y) = image.at(x, y);
    }
    if (!labels.left.empty())
        draw_labels(all, labels, line);
    return all;
}

Image picture_of(const GlContext& context, const Framebuffer& window)
{
    Framebuffer copy(context, {.width = window.width(), .height = window.height()});
    window.copy_to(copy);
    const std::vector<glm::vec4> texels = copy.read_color(copy.rect());
    std::array<float, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i)
        linear[i] = srgb_decode(static_cast<float>(i) / 255.0f);
    const auto decoded = [&](float shown) {
        return linear[static_cast<std::size_t>(std::lround(255.0f * shown))];
    };
    Image image(window.width(), window.height());
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::size_t row = static_cast<std::size_t>(image.height - 1 - y);
            const glm::vec4 texel =
                texels[row * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)];
            image.at(x, y) = glm::vec4(decoded(texel.r), decoded(texel.g), decoded(texel.b), 1.0f);
        }
    }
    return image;
}

}  // namespace surfelao
