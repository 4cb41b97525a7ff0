/// panel.h: the widgets beside the picture, and the mouse and keys that they leave to the picture.
#pragma once

#include "viewer/cell.h"
#include "viewer/cell_view.h"
#include "viewer/file_panel.h"
#include "viewer/flight.h"
#include "viewer/motion_panel.h"
#include "viewer/pane.h"
#include "viewer/saver.h"
#include "viewer/view_options.h"

#include <glm/vec2.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

struct GLFWwindow;

namespace surfelao {

/// How the right cell is shown.
enum class Beside {
    nothing,       ///< not at all
    wipe,          ///< right of a line
    side_by_side,  ///< in a picture of its own, by the same camera
};

/// What the widgets show and change.
struct PanelState {
    ViewOptions view;  ///< but its wipe, which follows from what is beside
    Beside beside = Beside::nothing;
    float wipe = 0.5f;         ///< where the line is, as a share of the picture's width
    bool shows_atlas = false;  ///< in place of the model, where there is a map
    bool is_hidden = false;
    bool inspects = false;  ///< what is under the mouse is told
    Flight flight;
    Cell left;
    /// Of its settings, only engine and texels count. None: rays, where the left one's values lie.
    std::optional<Cell> right;
    std::map<Engine, float> qualities;  ///< of the engines that are not chosen
    int reference_rays = 1024;          ///< even
    bool wants_reference = false;
    bool shows_help = false;
    SavePaths paths;
};

/// What is shown besides, per frame.
struct PanelFigures {
    double frame_ms = 0.0;  ///< to draw the model once
    int samples = 0;        ///< per pixel, so far
    std::string note;       ///< of the window: saved files, failures; one line or empty
    std::string device;     ///< what draws
    std::span<const std::filesystem::path> written;
    FileLists files;
    PaneLabels labels;                       ///< of what is beside each other
    const SaveQuestion* question = nullptr;  ///< shown above all else until there is a reply
};

/// What the user did in one frame.
struct PanelInput {
    bool view_changed = false;  ///< PanelState::view and what is beside
    bool frame_all = false;
    bool add_map = false;     ///< a cube map where the eye is
    bool place_maps = false;  ///< cube maps where they see most
    FileWishes files;
    bool cancel = false;
    bool solve_again = false;  ///< after it was cancelled
    bool close = false;
    SaveReply reply = SaveReply::none;  ///< to PanelFigures::question
    glm::vec2 orbit_deg{0.0f};          ///< azimuth, elevation
    glm::vec2 pan{0.0f};                ///< shares of the window's height, y upwards
    float zoom = 1.0f;                  ///< factor on the distance
    glm::vec2 look_deg{0.0f};           ///< in flight: to the right, upwards
    bool flies = false;                 ///< where the keys that are held lead
    float covered = 0.0f;  ///< share of the window's width, from the left, that the widgets keep
};

/// Whether what is to be shown needs a ray reference.
[[nodiscard]] bool needs_reference(const PanelState& state);

/// The right one with the left one's question.
[[nodiscard]] Cell right_cell(const PanelState& state);

/// Dear ImGui in a window whose context is current in this thread. At most one at a time.
class Panel {
public:
    static constexpr float kWidth = 360.0f;  ///< unscaled pixels

    explicit Panel(GLFWwindow* window);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    /// Takes the input that came since the last call and lays the widgets out. right: null where
    /// there is none of its own. moved: what motion shows. keys: pressed since then, in order:
    /// capital letters, digits, signs, and those below.
    PanelInput build(PanelState& state, const CellView& left, const CellView* right,
                     const PanelFigures& figures, MotionPanel& motion, const MotionView& moved,
                     std::string_view keys);
    static constexpr char kEscape = 27, kTab = 9, kSpace = ' ';

    /// Draws what build() laid out onto the window.
    void draw();

private:
    void widgets(PanelState& state, const CellView& left, const CellView* right,
                 const PanelFigures& figures, MotionPanel& motion, PanelInput& input);
    void fit_scale();
    void solver_widgets(PanelState& state, const Model* model);
    void compare_widgets(PanelState& state, const CellView& left, const CellView* right,
                         PanelInput& input);
    void mouse(PanelState& state, PanelInput& input, float wipe_x, float left);
    GLFWwindow* window_;
    float content_scale_ = 0.0f, pixel_ratio_ = 0.0f;  ///< that sizes are made for
    FilePanel files_;
    Cell edited_, edited_right_;       ///< what the widgets show while they are dragged
    Falloff falloff_ = Falloff::none;  ///< kept while the distance is unlimited
    WhereSettings where_;              ///< kept while the values lie elsewhere
    bool drags_wipe_ = false;
};

}  // namespace surfelao
