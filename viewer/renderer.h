/// renderer.h: draws a model with the device. The window and the picture file use it alike.
///
/// Everything the model needs lies on the device: moving the camera uploads and solves nothing.
#pragma once

#include "gpu/context.h"
#include "gpu/objects.h"
#include "image/image.h"
#include "pixels/camera.h"
#include "surfels/occlusion.h"
#include "viewer/base_paint.h"
#include "viewer/model.h"
#include "viewer/model_map.h"
#include "viewer/model_pose.h"
#include "viewer/pixel_values.h"
#include "viewer/view_options.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <span>

namespace surfelao {

/// Uses a context of somebody else, which must be current in every call and outlive it. All
/// functions throw std::runtime_error when the device refuses.
class Renderer {
public:
    /// Compiles the shaders. The light is that of builtin_sky().
    explicit Renderer(const GlContext& context);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Uploads a model, which is unoccluded until told otherwise. Throws when it is larger than the
    /// device's buffers.
    void set_model(const Model& model);

    /// Its vertices elsewhere, in the same number. The ground stays.
    void set_shape(const ModelShape& shape);

    /// Model::answer_count() values. Without a reference, the result stands in for it.
    void set_occlusion(std::span<const Occlusion> occlusion);
    void set_reference(std::span<const Occlusion> reference);

    /// From now on the model shows a map in place of the values at its vertices; only triangles do.
    /// Open until told otherwise. mesh: the model's.
    void set_layout(const Mesh& mesh, const ModelLayout& layout);
    void set_map(const ModelMap& map);
    void set_map_reference(const ModelMap& reference);
    /// And again the values at the vertices.
    void forget_layout();

    /// Fewer triangles in the model's place for ViewOptions::coarse (coarse.h): wedges of its
    /// surface. Until the next model. Splats are thinned out without being told.
    void set_coarse(std::span<const glm::uvec3> triangles);

    /// What the model is painted with for Colors::textured: white until told.
    void set_paint(const BasePaint& paint);

    /// Light for Colors::environment: see environment.h.
    void set_environment(const Image& panorama);

    /// A target that draw_frame() can draw into: linear float colour and depth.
    [[nodiscard]] Framebuffer make_target(int width, int height) const;

    /// Draws background, model and ground over all of the target; where the background is
    /// transparent colours are premultiplied. `shift`: the whole picture moved
    /// by a part of a pixel, for samples between -0.5 and 0.5. pixels: of this camera and size;
    /// then triangles are drawn.
    void draw_frame(const Framebuffer& target, const Camera& camera, const ViewOptions& options,
                    glm::vec2 shift = glm::vec2(0.0f), const PixelValues& pixels = {});

    /// The occlusion that draw_frame() would show at the pixels' middles, in red, and that of the
    /// reference, in green; alpha 0 where there is none. Of options, shape and culling count.
    void draw_values(const Framebuffer& target, const Camera& camera,
                     const ViewOptions& options = {}, const PixelValues& pixels = {});

    /// The background alone; no model is needed.
    void draw_background(const Framebuffer& target, const Camera& camera,
                         const ViewOptions& options);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao
