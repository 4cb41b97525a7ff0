/// pane.h: the pictures of the model in a window, and what is saved of them.
#pragma once

#include "gpu/context.h"
#include "gpu/objects.h"
#include "image/image.h"
#include "pixels/pixel_engine.h"
#include "viewer/cell_view.h"
#include "viewer/renderer.h"
#include "viewer/sample_sum.h"

#include <span>
#include <string>

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

/// The map of a cell in place of the model; the rays' where the pane shows them alone.
[[nodiscard]] Image flat_map(const Pane& pane, const CellView& cell, const ViewOptions& view);

/// What stands on both sides of a line; empty where there is no line.
struct PaneLabels {
    std::string left, right;
};

/// What the panes show, without the widgets, but with the line and what the labels say.
/// line: of the width, where it is.
[[nodiscard]] Image picture_of(std::span<const Pane> panes, const PaneLabels& labels, float line);

/// What a window shows now, the widgets too.
[[nodiscard]] Image picture_of(const GlContext& context, const Framebuffer& window);

}  // namespace surfelao
