/// pane.h: the pictures of the model in a window, and what is saved of them.
#pragma once

#include "gpu/context.h"
#include "gpu/objects.h"
#include "image/image.h"
#include "pixels/pixel_engine.h"
#include "viewer/renderer.h"
#include "viewer/sample_sum.h"

#include <span>

namespace surfelao {

/// Where a picture goes. Pixels of the window, y upwards.
struct PaneWish {
    Rect place;
    Rect shown;          ///< a part of it
    float wipe = 1.0f;   ///< ViewOptions::wipe
    bool right = false;  ///< of the right cell
};

/// A picture of the model in a part of the window, sample by sample.
struct Pane {
    Pane(const Renderer& renderer, const GlContext& context, const PaneWish& wish)
        : as(wish),
          target(renderer.make_target(wish.place.width, wish.place.height)),
          sum(context, wish.place.width, wish.place.height)
    {
    }
    PictureSize size() const { return {as.place.width, as.place.height}; }
    PaneWish as;
    Framebuffer target;
    SampleSum sum;
};

/// What the panes show, without what is around them.
[[nodiscard]] Image joined(std::span<const Pane> panes);

}  // namespace surfelao
