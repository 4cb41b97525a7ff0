/// window.h: the interactive viewer.
#pragma once

#include "image/image.h"
#include "viewer/panel.h"
#include "viewer/session.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

struct WindowOptions {
    std::filesystem::path input;  ///< may be empty: files can be opened in the window
    ReadOptions reading = {};     ///< of the input
    std::vector<std::filesystem::path> more_inputs;  ///< in the list of open files behind it
    std::filesystem::path recent_list;  ///< RecentFiles; empty: what was opened is not kept
    int width = 1280, height = 800;
    UpAxis up = UpAxis::y;
    std::string camera;                ///< parse_camera's words, for every file that is opened
    PanelState panel;                  ///< what the widgets begin with
    std::optional<Image> environment;  ///< a panorama; none = builtin_sky()
    std::vector<std::filesystem::path> other_inputs;  ///< read besides models: never replaced

    /// Asked at least twice a second; false closes the window (an interrupt, for example).
    std::function<bool()> keep_open = [] { return true; };

    /// Called after each frame with what the window shows; false closes it. For tests: drawing
    /// waits for every frame's pixels where it is set.
    std::function<bool(const Image& shown, const Session& session)> on_frame;
};

/// Opens a window and returns when it is closed. Moving the camera draws, and solves nothing; a
/// view at rest gets smoother, sample by sample, and costs nothing once it is done. Throws
/// std::runtime_error when there is no display or no OpenGL 3.3; everything later (files that
/// cannot be read or written) is told in the window. A file that was not written from this window
/// is replaced only when the user says so there, and one that was read never. Returns every file
/// that was written.
[[nodiscard]] std::vector<std::filesystem::path> show_window(const WindowOptions& options);

}  // namespace surfelao
