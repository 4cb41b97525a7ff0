/// grid_layer.h: the AO grid round a model in a window, and what it tells of a picture's pixels: of
/// the grid alone, in every frame, as it is read anywhere about the object.
#pragma once

#include "pixels/grid_pass.h"
#include "viewer/cell.h"
#include "viewer/grid_session.h"
#include "viewer/session.h"
#include "viewer/shot.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {

/// In one thread, the context's.
class GridLayer {
public:
    explicit GridLayer(const GlContext& context) : context_(context) {}

    void forget();  ///< the grid: of another model
    /// Whether a picture shows something else than before.
    [[nodiscard]] bool update();

    /// Once a frame where the cell is at a grid. True where other values lie on the pixels.
    [[nodiscard]] bool look(Shot& shot, const Session& session, const Cell& cell);
    /// What the grid tells of a shot. Whether there was something.
    bool forget_picture() { return std::exchange(is_drawn_, false); }

    /// R32F (PixelForm::visibility); null where there is no grid of the last look().
    [[nodiscard]] const Texture2D* picture() const
    {
        return is_drawn_ ? &picture_->color() : nullptr;
    }
    /// The occlusion at a pixel of it. Waits for the device.
    [[nodiscard]] float told(glm::ivec2 pixel) const;

    const GridBake* grid() const { return session_.found().get(); }  ///< null: not yet
    std::optional<double> progress() const;
    bool is_busy() const { return session_.solving(); }
    bool was_cancelled() const { return session_.was_cancelled(); }
    const std::string& message() const { return session_.message(); }
    void cancel() { session_.cancel(); }
    void solve_again() { session_.ask_again(); }

private:
    const GlContext& context_;
    std::optional<GridPass> pass_;     ///< with the grid on the device; empty until it is wanted
    std::vector<PlacedGrid> objects_;  ///< one, or none yet
    std::optional<Framebuffer> picture_;
    bool is_drawn_ = false;  ///< it shows the shot
    GridSession session_;
};

}  // namespace surfelao
