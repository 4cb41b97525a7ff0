/// cell_view.h: a cell solved and drawn: its session, its pixels, and what of both lies on the
/// device of a window.
#pragma once

#include "bake/statistics.h"
#include "gpu/screen_space.h"
#include "pixels/pixel_engine.h"
#include "viewer/base_paint.h"
#include "viewer/cell.h"
#include "viewer/cube_layer.h"
#include "viewer/grid_layer.h"
#include "viewer/moving_session.h"
#include "viewer/pixel_session.h"
#include "viewer/renderer.h"
#include "viewer/session.h"
#include "viewer/shot.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {

/// How far what a picture shows is from rays at some of its pixels.
struct ShownError {
    ErrorStatistics found;   ///< its count: the pixels
    std::uint32_t rays = 0;  ///< each
};

/// Which rays are traced at the pixels.
struct PixelRays {
    std::uint32_t rays = 0;  ///< a pixel; 0: none
    bool whole = false;      ///< at all pixels; else at kErrorPixels of them
    bool operator==(const PixelRays&) const = default;
};

/// In one thread, the context's. What is at pixels is of one camera: where the camera moves it is
/// forgotten, and solved again once the camera rests for a frame. Methods that ask the picture
/// alone are drawn in every frame, and so is what grids tell.
class CellView {
public:
    explicit CellView(const GlContext& context);

    Session& session() { return session_; }
    const Session& session() const { return session_; }
    Renderer& renderer() { return renderer_; }

    /// What the background threads have finished goes to the device. Throws where that refuses.
    struct Changes : Session::Changes {
        bool pixels = false;
    };
    [[nodiscard]] Changes update();

    /// From now on a model whose parts move is shown, until the session has another pose or model.
    /// base: that the frame is of. has_values: the frame's are this cell's. What pixels see by
    /// themselves is asked again once it rests; methods of the picture and grids follow each frame.
    void show_moved(const std::shared_ptr<const Model>& base,
                    const std::shared_ptr<const MovingFrame>& frame, bool has_values);
    bool is_moved() const { return moved_ != nullptr; }
    /// That is shown, with its triangles; null until there is one.
    const std::shared_ptr<const Model>& model() const { return drawn_; }
    /// Positions that are shown. A model must be there.
    std::span<const glm::vec3> positions() const;
    std::span<const glm::vec3> wedge_normals() const;  ///< likewise
    /// Answers at vertices that are shown there; empty where there are none, or a map.
    std::span<const Occlusion> vertex_values() const;
    /// At vertices, in a map, or at pixels: there is something to show.
    bool has_values() const;
    /// The same, or the colours need no answer.
    bool can_show(Colors colors) const;

    /// Once a frame, before it is drawn. A model must be there. True where other values lie on the
    /// pixels than before. view: as it is drawn; Colors::radius has values of its own, and what is
    /// coarse does not rest. Throws std::runtime_error where the device refuses, SettingsError for
    /// settings out of their ranges.
    [[nodiscard]] bool look(const Cell& cell, const Camera& camera, PictureSize size,
                            const PixelRays& rays, const ViewOptions& view = {});
    /// Of the last look().
    PictureSize picture_size() const { return shot_.size(); }

    /// CubeLayer::add() and place(), of the last look().
    [[nodiscard]] std::string add_map() { return cubes_.add(shot_); }
    void place_maps() { cubes_.place(shot_.model()); }
    const CubeLayer& cubes() const { return cubes_; }
    const GridLayer& grid() const { return grid_; }

    /// Read when it is first wanted. Its notes.
    std::span<const std::string> take_paint();
    const BasePaint* paint() const { return paint_ ? &*paint_ : nullptr; }

    /// Renderer::draw_frame(), with the pixels' values where look() has found some.
    void draw_frame(const Framebuffer& target, const Camera& camera, const ViewOptions& options,
                    glm::vec2 shift);

    bool has_pixels() const { return pixel_values().own != nullptr; }
    /// By rays, where the values shown lie.
    bool has_reference() const
    {
        return has_pixels() ? rays_picture_.has_value()
                            : !is_moved() && session_.state().has_reference();
    }
    const std::optional<ShownError>& pixel_error() const { return error_; }
    const PixelAnswers& pixels() const { return pixels_.answers(); }
    const PixelAnswers& ray_pixels() const { return rays_.answers(); }
    /// The occlusion at a pixel of the last look() where a method of the picture, cube maps or a
    /// grid tell it alone. Waits for the device.
    [[nodiscard]] std::optional<float> told_by_picture(glm::ivec2 pixel) const;
    bool is_busy() const;
    bool was_cancelled() const
    {
        return session_.was_cancelled() || was_cancelled_ || grid_.was_cancelled();
    }
    /// 0 to 1 where pixels are solved, or rays traced at them.
    std::optional<double> pixel_progress() const;
    std::optional<double> ray_progress() const;
    /// What went wrong at the pixels; else empty.
    const std::string& pixel_message() const;

    /// Stops what runs in the background; what was found stays.
    void cancel();
    /// After cancel().
    void solve_again();

private:
    [[nodiscard]] PixelValues pixel_values() const;
    void take_model(const Session::Changes& changes);
    void forget_shot();
    void forget_answers();
    bool forget_picture();
    bool forget_screen();
    [[nodiscard]] bool draw_screen(const Cell& cell, bool shows_radius);
    void ask_pixels(EngineSettings engine);
    void ask_rays(const PixelRays& rays);
    [[nodiscard]] Texture2D upload(const PixelAnswers& found) const;
    void take_map();
    void measure();

    const GlContext& context_;
    Session session_;
    Renderer renderer_;
    std::shared_ptr<const ModelLayout> layout_;  ///< that the renderer has
    std::optional<BasePaint> paint_;             ///< of the model; empty until it is wanted

    std::shared_ptr<const MovingFrame> moved_;  ///< null: the session's model is shown
    bool moved_has_values_ = false;
    std::shared_ptr<const PosedBodies> posed_;  ///< in the pose that is drawn; null: as it was read
    std::shared_ptr<const Model> drawn_;        ///< that the renderer has
    bool has_coarse_ = false;                   ///< the renderer has its coarse triangles, too

    Shot shot_;
    std::optional<ScreenSpace> screen_;
    std::optional<Framebuffer> screen_picture_;
    struct ScreenQuestion {
        ScreenSettings settings;
        Definition definition;
        int guard = 0;
        bool radius = false;  ///< in place of occlusion
        bool operator==(const ScreenQuestion&) const = default;
    };
    std::optional<ScreenQuestion> screen_asked_;  ///< of the shot
    std::optional<EngineSettings> asked_;
    std::optional<std::pair<PixelRays, Definition>> rays_asked_;
    std::optional<Texture2D> picture_, rays_picture_;
    bool is_measured_ = false;  ///< error_ is of what is shown
    std::optional<ShownError> error_;
    bool was_cancelled_ = false;  ///< the pixels, before their end
    PixelSession pixels_, rays_;
    CubeLayer cubes_;
    GridLayer grid_;
};

}  // namespace surfelao
