#include "viewer/pane_labels.h"

namespace surfelao {
namespace {

/// What colours tell that are of no answer; else empty.
std::string label_of_surface(Colors colors)
{
    switch (colors) {
        case Colors::normals:
            return "normals";
        case Colors::levels:
            return "octree levels";
        case Colors::charts:
            return "charts";
        case Colors::density:
            return "texel density";
        default:
            return {};
    }
}

}  // namespace

std::string label_of(const Cell& cell, const CellView& view, Colors colors)
{
    const Model* model = view.session().state().model.get();
    const std::string who = how_of(cell) + " at " + name_of(where_of(cell), model && model->cloud);
    const std::string surface = label_of_surface(colors);
    if (!surface.empty() && (colors != Colors::normals || view.has_values()))
        return surface;
    if (!view.has_values() || (cell.at_pixels && !view.has_pixels()))
        return who + ": not yet";
    if (colors == Colors::rays)
        return view.has_reference() ? "rays" : who + " (no rays yet)";
    if (colors == Colors::difference)
        return view.has_reference() ? who + " less rays" : who + " (no rays yet)";
    if (colors == Colors::bent_normals)
        return who + ": bent normals";
    return colors == Colors::radius ? who + ": radius" : who;
}

PaneLabels labels_with_rays(const Cell& cell, const CellView& view, Colors colors,
                            bool in_own_picture)
{
    const std::string left = label_of(cell, view, colors);
    if (!view.has_reference())
        return {left, left + " (no rays yet)"};
    const Colors right = in_own_picture ? colors_of_rays(colors) : colors;
    if (!label_of_surface(right).empty() || right == Colors::difference)
        return {left, left};
    return {left, right == Colors::bent_normals ? "rays: bent normals" : "rays"};
}

Colors colors_of_rays(Colors colors)
{
    return colors == Colors::difference ? Colors::visibility : colors;
}

}  // namespace surfelao
