/// panel_widgets.h: the parts of the panel that need no more than what they show; for panel.cpp
/// alone. All are called between ImGui's NewFrame and Render.
#pragma once

#include "viewer/panel.h"

#include <cstdint>
#include <optional>

namespace surfelao {

/// The limit, in % of the diagonal. falloff: what a limit has, once there is one. True when it is
/// to be solved: not while a slider is dragged.
bool edit_distance(DistanceLimit& limit, Falloff& falloff);

/// The same for a ground that occludes. model: as it is shown, or null.
bool edit_ground(std::optional<GroundPlane>& ground, const Model* model);

/// The same for the surface's normals and what the values at vertices are.
bool edit_target(TargetSettings& target);

/// The same for a map.
bool edit_texels(TexelSettings& texels);

/// The parts of the model's scene with two ticks each, and what light goes through. The last part
/// that is baked stays so. A vertex of the part whose name was clicked, if one was.
std::optional<std::uint32_t> edit_parts(const Scene& scene, PartChoice& parts);

/// How the model is shown. True when anything changed.
bool view_widgets(PanelState& state);

/// A bar with words. done: 0 to 1.
void progress_line(const char* what, double done);

/// How far a cell is, one bar each for its session and its pixels.
void cell_progress(const CellView& view);

/// What a picture shows against rays at its pixels.
void error_lines(const ShownError& error);

/// How many cube maps there are, and how much they show. True when they are to be placed.
bool map_lines(const CellView& view);

/// What an AO grid is.
void grid_lines(const CellView& view);

/// What a picture's pixels took.
void pixel_lines(const CellView& view);

/// Times and errors.
void stage_lines(const SessionState& s);

/// How many vertices are how closed.
void histogram(const Session& session);

}  // namespace surfelao
