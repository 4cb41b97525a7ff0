/// panel.h: the widgets over the picture, and the mouse and keys that they leave to the picture.
#pragma once

#include "viewer/session.h"
#include "viewer/view_options.h"

#include <glm/vec2.hpp>

#include <string>

struct GLFWwindow;

namespace surfelao {

/// What the widgets show and change.
struct PanelState {
    ViewOptions view;
    SolveSettings settings;
    int reference_rays = 1024;  ///< even
    bool wants_reference = false;
    bool shows_help = false;
    char picture_path[512] = "picture.png";
    char baked_path[512] = "baked.ply";
};

/// What is shown besides, per frame.
struct PanelFigures {
    double frame_ms = 0.0;  ///< to draw the model once
    int samples = 0;        ///< per pixel, so far
    std::string note;       ///< of the window: saved files, failures; one line or empty
    std::string device;     ///< what draws
};

/// What the user did in one frame.
struct PanelInput {
    bool view_changed = false;  ///< PanelState::view
    bool frame_all = false;
    bool save_picture = false;
    bool save_baked = false;
    bool cancel = false;
    bool close = false;
    glm::vec2 orbit_deg{0.0f};  ///< azimuth, elevation
    glm::vec2 pan{0.0f};        ///< shares of the window's height, y upwards
    float zoom = 1.0f;          ///< factor on the distance
};

/// Dear ImGui in a window whose context is current in this thread. At most one at a time.
class Panel {
public:
    /// scale: of all sizes, for displays of high density.
    Panel(GLFWwindow* window, float scale);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    /// Takes the input that came since the last call and lays the widgets out.
    PanelInput build(PanelState& state, const Session& session, const PanelFigures& figures);

    /// Draws what build() laid out onto the window.
    void draw();

private:
    SolveSettings edited_;
};

}  // namespace surfelao
