/// pane_labels.h: words for what a picture shows.
#pragma once

#include "viewer/cell_view.h"

#include <string>

namespace surfelao {

/// "masks at pixels", "normals", "masks at vertices less rays". colors: that are drawn, which are
/// Colors::normals where nothing has answered yet: that is told too.
[[nodiscard]] std::string label_of(const Cell& cell, const CellView& view, Colors colors);

/// The same for the part of its picture that shows the reference.
[[nodiscard]] std::string label_of_rays(const Cell& cell, const CellView& view, Colors colors);

}  // namespace surfelao
