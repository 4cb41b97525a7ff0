#include "viewer/pane_layout.h"

#include <algorithm>

namespace surfelao {

std::vector<PaneWish> wanted_panes(const Rect& part, Beside beside, float wipe, bool traced,
                                   bool right)
{
    if (beside == Beside::side_by_side && part.width > 1) {
        const int half = part.width / 2;
        const Rect low = {part.x, part.y, half, part.height};
        const Rect high = {part.x + part.width - half, part.y, half, part.height};
        return {{low, low}, {high, high, traced && !right ? 0.0f : 1.0f, right}};
    }
    if (beside == Beside::wipe && right) {
        const auto line = static_cast<int>(wipe * static_cast<float>(part.width));
        return {{part, {part.x, part.y, line, part.height}},
                {part, {part.x + line, part.y, part.width - line, part.height}, 1.0f, true}};
    }
    return {{part, part, traced && beside == Beside::wipe ? wipe : 1.0f}};
}

bool is_in_place(const Pane& pane, const PaneWish& wish)
{
    const Rect &a = pane.as.place, &b = wish.place;
    return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height &&
           pane.as.right == wish.right;
}

std::vector<Rect> places_of(std::span<const Pane> panes)
{
    std::vector<Rect> places;
    for (const Pane& pane : panes) {
        const Rect& own = pane.as.place;
        if (std::ranges::find(places, own.x, &Rect::x) == places.end())
            places.push_back(own);
    }
    return places;
}

PictureSize drawn_size(const Pane& pane, const Detail& detail)
{
    const Rect& place = pane.as.place;
    return {(place.width - 1) / detail.pixel + 1, (place.height - 1) / detail.pixel + 1};
}

void fit_target(Pane& pane, const Renderer& renderer, const Detail& detail)
{
    const auto [width, height] = drawn_size(pane, detail);
    if (width != pane.target.width() || height != pane.target.height())
        pane.target = renderer.make_target(width, height);
}

}  // namespace surfelao
