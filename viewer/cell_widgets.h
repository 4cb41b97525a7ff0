/// cell_widgets.h: the widgets of a cell of the table where x how; for panel.cpp alone. All are
/// called between ImGui's NewFrame and Render, and are true when the cell is to be solved.
#pragma once

#include "viewer/cell.h"

#include <map>

namespace surfelao {

/// The list of places that the model has. settings: what a map or a grid has, once there is one.
bool choose_where(Cell& cell, const Model* model, const WhereSettings& settings);

/// The list of those who can answer there. qualities: of the engines that are not chosen.
bool choose_how(Cell& cell, std::map<Engine, float>& qualities);

/// The settings of who answers: not while a slider is dragged.
bool edit_how(Cell& cell);

}  // namespace surfelao
