/// probe_box.h: a marker at a place of the picture, and a box beside it that tells of the place.
#pragma once

#include "viewer/cell.h"
#include "viewer/cell_view.h"
#include "viewer/motion_panel.h"

namespace surfelao {

/// Where the mouse is over one of the view's pictures: what the cell knows there. Nothing while a
/// button is down. Between ImGui's NewFrame and Render. O(triangles).
void tell_place(const MotionView& view, const CellView& cell_view, const Cell& cell);

}  // namespace surfelao
