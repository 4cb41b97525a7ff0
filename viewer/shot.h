/// shot.h: what the pixels of one picture see of a model, drawn once it is asked for.
#pragma once

#include "gpu/g_buffer.h"
#include "pixels/camera.h"
#include "pixels/pixel_engine.h"
#include "viewer/model.h"
#include "viewer/moving_session.h"
#include "viewer/pixel_session.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace surfelao {

/// Uses the context in every call that draws.
class Shot {
public:
    explicit Shot(const GlContext& context) : context_(context) {}

    /// Of this model, elsewhere where it moves; the picture is forgotten.
    void set_model(std::shared_ptr<const Model> model,
                   std::shared_ptr<const MovingFrame> moved = nullptr);
    const std::shared_ptr<const Model>& model() const { return model_; }  ///< null before that

    /// Another picture of the model. False where it is the one at hand.
    bool take(const Camera& camera, PictureSize size, bool is_culled);
    void forget();  ///< the picture

    /// All below are of the last take().
    const Camera& camera() const { return camera_; }
    PictureSize size() const { return size_; }
    bool is_culled() const { return is_culled_; }
    const DrawnMesh& mesh();
    const GBuffer& drawn();
    /// So many pixels larger on each side; 0: drawn().
    const GBuffer& drawn_with_guard(int guard);
    /// GBuffer::read_triangles(). Waits once.
    const std::vector<std::uint32_t>& triangles();
    /// Of all pixels. engine: with the definition.
    [[nodiscard]] PixelQuestion question_for(const EngineSettings& engine);
    const Texture2D& surface() const { return buffer_->surface(); }  ///< once it is drawn

private:
    void draw(std::optional<GBuffer>& buffer, int guard);
    const GlContext& context_;
    std::shared_ptr<const Model> model_;
    std::shared_ptr<const MovingFrame> moved_;  ///< null: the model is at rest
    std::optional<DrawnMesh> mesh_;             ///< of it; empty until it is wanted
    Camera camera_;
    PictureSize size_;
    bool is_culled_ = false;
    bool is_there_ = false;  ///< take() has told which picture it is
    std::optional<GBuffer> buffer_, wide_;
    bool is_drawn_ = false;
    std::optional<int> guard_;              ///< of wide_, where it shows the picture
    std::vector<std::uint32_t> triangles_;  ///< empty until they were read
};

}  // namespace surfelao
