/// pane_layout.h: where the pictures of a window lie, and how finely they are drawn.
#pragma once

#include "viewer/coarse.h"
#include "viewer/pane.h"
#include "viewer/panel.h"

#include <span>
#include <vector>

namespace surfelao {

/// Those in a part of a window. right: there is a right cell of its own; traced: the left one has a
/// reference. One that is not there yet is not shown instead of the result.
[[nodiscard]] std::vector<PaneWish> wanted_panes(const Rect& part, Beside beside, float wipe,
                                                 bool traced, bool right);

/// Whether it stands where it is wanted, with what is wanted.
[[nodiscard]] bool is_in_place(const Pane& pane, const PaneWish& wish);
/// Each once: pictures of a wipe lie over each other.
[[nodiscard]] std::vector<Rect> places_of(std::span<const Pane> panes);

/// Of what is drawn for a pane.
[[nodiscard]] PictureSize drawn_size(const Pane& pane, const Detail& detail);
/// The pane's target becomes as large as that.
void fit_target(Pane& pane, const Renderer& renderer, const Detail& detail);

}  // namespace surfelao
