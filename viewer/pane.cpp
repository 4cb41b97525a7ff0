#include "viewer/pane.h"

#include <algorithm>

namespace surfelao {

Image joined(std::span<const Pane> panes)
{
    int right = 0;
    for (const Pane& pane : panes)
        right = std::max(right, pane.as.place.x + pane.as.place.width);
    const Rect& first = panes.front().as.place;
    Image all(right - first.x, first.height);
    for (const Pane& pane : panes) {
        const Image image = pane.sum.mean();
        const int left = pane.as.shown.x - pane.as.place.x;
        for (int y = 0; y < image.height; ++y)
            for (int x = left; x < left + pane.as.shown.width; ++x)
                all.at(pane.as.place.x - first.x + x, y) = image.at(x, y);
    }
    return all;
}

}  // namespace surfelao
