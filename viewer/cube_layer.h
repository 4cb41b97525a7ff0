/// cube_layer.h: cube maps of a model in a window: where they are, who answers their texels, and
/// what they tell of a picture's pixels, the holes between them included.
#pragma once

#include "gpu/screen_space.h"
#include "pixels/cube_projector.h"
#include "viewer/cell.h"
#include "viewer/cube_session.h"
#include "viewer/pixel_session.h"
#include "viewer/session.h"
#include "viewer/shot.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {

/// In one thread, the context's.
class CubeLayer {
public:
    explicit CubeLayer(const GlContext& context) : context_(context) {}

    void forget();  ///< all maps: of another model
    /// Whether a picture may show something else than before.
    [[nodiscard]] bool update();

    /// Puts a map where the camera is. It must not be in a body: what is wrong with the place, or
    /// an empty text.
    [[nodiscard]] std::string add(Shot& shot);
    /// In place of all that are there maps where they see most of the surface (cube_placement.h).
    void place(const std::shared_ptr<const Model>& model);

    /// Once a frame where the cell is at cube maps. rests: the shot is that of the last frame.
    /// shows_holes: they are not solved. True where other values lie on the pixels.
    [[nodiscard]] bool look(Shot& shot, const Session& session, const Cell& cell, bool rests,
                            bool shows_holes);
    /// What the maps tell of a shot, the maps themselves stay. Whether there was something.
    bool forget_picture();

    /// RG32F (PixelForm::covered); null where there is no map of the last look().
    [[nodiscard]] const Texture2D* picture() const;
    /// The occlusion at a pixel of it, if it is told. Waits for the device.
    [[nodiscard]] std::optional<float> told(glm::ivec2 pixel) const;

    std::size_t count() const { return places_.size(); }  ///< with those that are not solved yet
    /// Of the pixels that see something, the share that maps answer; while the camera rests.
    const std::optional<double>& coverage() const { return coverage_; }
    bool is_busy() const { return session_.busy() || holes_.is_busy(); }
    bool is_placing() const { return session_.placing(); }
    std::optional<double> progress() const;
    const std::string& message() const;  ///< what went wrong; else empty

    /// Gives up what runs; maps that are not solved yet are forgotten.
    void cancel();
    void solve_again() { holes_asked_.reset(); }  ///< the holes, after cancel()

private:
    struct Place {
        glm::vec3 centre{0.0f};
        std::shared_ptr<const CubeSight> sight;  ///< null until it was looked around from there
    };
    /// Who answers texels.
    struct Asked {
        EngineSettings engine;                  ///< with the definition
        std::optional<ScreenSettings> horizon;  ///< in its place
        bool operator==(const Asked&) const = default;
    };
    void ask(const Session& session, const Cell& cell);
    void answer_next(Shot& shot, const Session& session);
    void take(CubeMap map);
    [[nodiscard]] bool project(Shot& shot, bool rests);
    void measure_coverage(Shot& shot);
    void ask_holes(Shot& shot, const Session& session, EngineSettings engine);
    void fill_holes();
    void forget_coverage();

    const GlContext& context_;
    std::optional<ScreenSpace> screen_;  ///< of horizons; empty until it is wanted
    std::vector<Place> places_;
    std::optional<Asked> asked_;
    std::optional<CubeProjector> projector_;
    std::vector<float> weights_;  ///< of the maps that are solved, the first places: they fade in
    std::optional<Framebuffer> picture_;
    bool is_projected_ = false;  ///< it shows the shot
    std::optional<double> coverage_;
    std::vector<glm::vec4> projected_;  ///< CubeProjector::project() of the shot, with coverage_
    std::optional<EngineSettings> holes_asked_;
    std::optional<Texture2D> filled_;  ///< the picture with its holes solved
    bool shows_holes_ = false;
    std::string message_;
    PixelSession holes_;
    CubeSession session_;
};

}  // namespace surfelao
