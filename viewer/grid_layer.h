/// grid_layer.h: the AO grid round a model in a window, or those round its parts where they move,
/// and what they tell of a picture's pixels, in every frame: of grids alone, but for what an object
/// that moves hides from its own surface, which is found at its vertices.
#pragma once

#include "pixels/grid_pass.h"
#include "viewer/cell.h"
#include "viewer/grid_objects.h"
#include "viewer/grid_session.h"
#include "viewer/model_pose.h"
#include "viewer/session.h"
#include "viewer/shot.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {

/// In one thread, the context's.
class GridLayer {
public:
    explicit GridLayer(const GlContext& context) : context_(context) {}

    /// Grids of other models are forgotten.
    void keep_of(const std::shared_ptr<const Model>& model);
    /// Whether a picture shows something else than before.
    [[nodiscard]] bool update();

    /// Once a frame where the cell is at a grid. posed: what moves, in the pose that the shot
    /// shows; null: nothing does. is_moving: the shot's model does not stand in that pose by
    /// itself. True where other values lie on the pixels.
    [[nodiscard]] bool look(Shot& shot, const Session& session, const Cell& cell,
                            const std::shared_ptr<const PosedBodies>& posed, bool is_moving);
    /// In place of look() where the cell is elsewhere. Whether there was something.
    bool leave();
    /// What the grids tell of a shot. Whether there was something.
    bool forget_picture() { return std::exchange(is_drawn_, false); }

    /// R32F (PixelForm::visibility); null where there are no grids of the last look().
    [[nodiscard]] const Texture2D* picture() const
    {
        return is_drawn_ ? &picture_->color() : nullptr;
    }
    /// The occlusion at a pixel of it. Waits for the device.
    [[nodiscard]] float told(glm::ivec2 pixel) const;

    /// One per object; empty: not yet.
    std::span<const std::shared_ptr<const ObjectGrid>> grids() const;
    std::optional<double> progress() const;
    bool is_busy() const { return session_.solving(); }
    bool was_cancelled() const { return session_.was_cancelled(); }
    /// What went wrong, or is left out; else empty.
    const std::string& message() const
    {
        return session_.message().empty() ? left_out_ : session_.message();
    }
    void cancel() { session_.cancel(); }
    void solve_again() { session_.ask_again(); }

private:
    void find_objects(const PosedBodies* posed);
    void find_own(const std::shared_ptr<const Model>& model);
    void draw(Shot& shot, const std::vector<PlacedGrid>& objects);

    const GlContext& context_;
    std::shared_ptr<const Bodies> bodies_;        ///< that objects_ are of
    std::vector<bool> rests_;                     ///< likewise
    std::shared_ptr<const GridObjects> objects_;  ///< of the last look(); null: the whole
    std::optional<GridPass> pass_;                ///< empty until it is wanted
    std::shared_ptr<const FoundGrids> in_pass_;   ///< whose grids it has on the device
    /// Of the shot's triangles, as GBuffer::draw_values() takes them; empty until it is wanted.
    std::optional<TextureBuffer> own_;
    std::shared_ptr<const Model> own_of_;  ///< whose triangles those are
    std::optional<Framebuffer> picture_, own_picture_;
    bool is_drawn_ = false;  ///< it shows the shot
    std::string left_out_;
    GridSession session_;
};

}  // namespace surfelao
