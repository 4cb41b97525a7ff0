/// pane_labels.h: words for what a picture shows.
#pragma once

#include "viewer/cell_view.h"
#include "viewer/pane.h"

#include <string>

namespace surfelao {

/// "masks at pixels", "normals", "masks at vertices less rays". colors: that are drawn, which are
/// Colors::normals where nothing has answered yet: that is told too.
[[nodiscard]] std::string label_of(const Cell& cell, const CellView& view, Colors colors);

/// Of a cell and the reference that it is compared with, whose picture may be one of its own.
[[nodiscard]] PaneLabels labels_with_rays(const Cell& cell, const CellView& view, Colors colors,
                                          bool in_own_picture);

/// What such a picture is drawn in: the reference has no difference to itself.
[[nodiscard]] Colors colors_of_rays(Colors colors);

}  // namespace surfelao
