/// ui_scale.h: how large widgets and their letters are.
#pragma once

namespace surfelao {

/// Letters of DejaVu Sans where the system has it (Debian: fonts-dejavu-core), drawn for the size
/// at hand; else the built-in bitmap font in whole steps.
///
/// content_scale: pixels on the display for one of a display of 96 dpi. pixel_ratio: pixels on the
/// display for a unit of the window system's, in which ImGui measures. All sizes follow from
/// ImGuiIO::FontGlobalScale: units of the window for one pixel of a display of 96 dpi. Between
/// frames, with the window's context current.
void set_ui_scale(float content_scale, float pixel_ratio);

}  // namespace surfelao
