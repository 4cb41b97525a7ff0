/// tip.h: what a widget does, where the mouse rests on it.
#pragma once

namespace surfelao {

/// Of the widget before it, also where that is greyed out. Between ImGui's NewFrame and Render.
void tip(const char* text);

}  // namespace surfelao
