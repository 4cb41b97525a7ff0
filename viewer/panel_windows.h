/// panel_windows.h: what lies over the picture; for panel.cpp alone. All are called between ImGui's
/// NewFrame and Render.
#pragma once

#include "image/legend.h"
#include "viewer/saver.h"

namespace surfelao {

/// The twin of draw_legend, in the lower right corner of the window.
void legend(const Legend& shown);

/// The keys. open: false when it was closed.
void help_window(bool& open);

/// Nothing else can be used while it is shown. Sets the reply when there is one.
void question_window(const SaveQuestion& question, SaveReply& reply);

}  // namespace surfelao
