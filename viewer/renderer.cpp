#include "viewer/renderer.h"

#include "gpu/draw.h"
#include "gpu/program.h"
#include "image/color_map.h"
#include "surfels/errors.h"
#include "viewer/environment.h"
#include "viewer/model_upload.h"
#include "viewer/split_surface.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

constexpr int kMaxSkyWidth = 1024;      // the background is out of focus: more would not be seen
constexpr float kSkyBlurWidth = 64.0f;  // columns of the panorama that can still be told apart
constexpr float kNearest =
    1e-4f;  // near plane as a share of the far one, for eyes inside the scene
constexpr std::size_t kCoarseSplats = 30'000;
constexpr float kPush = 0.3f;  // of a splat's radius: how far apart overlapping disks may lie

std::vector<glm::vec4> occlusion_texels(std::span<const Occlusion> values)
{
    std::vector<glm::vec4> texels;
    texels.reserve(values.size());
    for (const Occlusion& value : values)
        texels.emplace_back(value.bent_normal, value.occlusion);
    return texels;
}

/// From (pixel, 1) to the direction in which it is seen, where the picture is moved by `shift`.
glm::mat3 sight_matrix(const Camera& camera, glm::vec2 size, glm::vec2 shift)
{
    const CameraAxes axes = camera_axes(camera);
    const float half = std::tan(0.5f * glm::radians(camera.fovy_deg));
    const glm::vec3 across = 2.0f * half / size.y * axes.right;
    const glm::vec3 along = 2.0f * half / size.y * axes.upwards;
    const glm::vec2 middle = 0.5f * size + shift;
    return {across, along, -axes.backwards - middle.x * across - middle.y * along};
}

Texture2D upload_image(const GlContext& context, const Image& image, const TextureOptions& options)
{
    return {context,
            image.width,
            image.height,
            TexelFormat::rgba32f,
            std::span<const glm::vec4>(image.pixels),
            options};
}

/// In the order of ColorMap.
std::vector<Texture2D> upload_color_maps(const GlContext& context)
{
    std::vector<Texture2D> maps;
    for (int map = 0; map <= static_cast<int>(ColorMap::diverging); ++map) {
        Image row(static_cast<int>(kMapSteps), 1);
        for (std::size_t x = 0; x < kMapSteps; ++x)
            row.pixels[x] = glm::vec4(colors_of(static_cast<ColorMap>(map))[x], 1.0f);
        maps.push_back(upload_image(context, row, {.filter = TextureFilter::linear}));
    }
    return maps;
}

}  // namespace

struct Renderer::Impl {
    explicit Impl(const GlContext& gl)
        : context(gl),
          surface(gl, "surface.vert", "surface.frag"),
          split(gl),
          disks(gl, "splat_disk.vert", "splat_disk.frag"),
          disk_depth(gl, "splat_depth.vert", "splat_depth.frag"),
          resolve(gl, "fullscreen.vert", "splat_resolve.frag"),
          affine(gl, "splat_square.vert", "splat_affine.frag"),
          points(gl, "splat_square.vert", "splat_point.frag"),
          background(gl, "fullscreen.vert", "background.frag"),
          shadow(gl, "ground.vert", "ground.frag"),
          nothing(gl),
          color_maps(upload_color_maps(gl))
    {
    }

    /// What every drawing of this frame has in common.
    struct Frame {
        const Framebuffer& target;
        const Camera& camera;
        const ViewOptions& options;
        const PixelValues& pixels;
        glm::mat4 view, projection;
        glm::mat3 sight;
        [[nodiscard]] Cull cull() const { return options.cull ? Cull::back : Cull::none; }
    };

    [[nodiscard]] Frame frame_of(const Framebuffer& target, const Camera& camera,
                                 const ViewOptions& options, const PixelValues& pixels,
                                 glm::vec2 shift) const
    {
        const glm::vec2 size(target.width(), target.height());
        // as much depth precision as the place of the eye allows
        const float distance = glm::length(camera.eye);
        const float far = distance + upload->radius;
        const float near = std::max(distance - upload->radius, far * kNearest);
        return {target,
                camera,
                options,
                pixels,
                view_matrix(camera),
                projection_matrix(camera, size.x / size.y, near, far, 2.0f * shift / size),
                sight_matrix(camera, size, shift)};
    }

    void set_shading(Program& program, const Frame& frame)
    {
        program.set("u_colors", static_cast<int>(frame.options.colors));
        program.set("u_wipe_x", frame.options.wipe * static_cast<float>(frame.target.width()));
        program.set("u_difference_scale", frame.options.difference_scale);
        const ColorMap map = map_of(frame.options);
        program.set("u_is_signed", map == ColorMap::diverging ? 1 : 0);
        program.set("u_color_map", color_maps[static_cast<std::size_t>(map)]);
        program.set("u_irradiance", *irradiance);
        program.set("u_sky_frame", sky_frame(frame.camera.up));
        program.set("u_exposure", base_exposure * std::exp2(frame.options.exposure));
        program.set("u_sight", frame.sight);
    }

    void set_model_texels(Program& program)
    {
        program.set("u_positions", upload->positions);
        program.set("u_occlusion", upload->occlusion);
        program.set("u_reference", upload->reference ? *upload->reference : upload->occlusion);
    }

    void set_splats(Program& program, const Frame& frame)
    {
        program.set("u_surfels", upload->surfels);
        program.set("u_splats", upload->splats);
        program.set("u_radii", upload->radii);
        const std::size_t stride = splat_stride(frame);
        program.set("u_splat_stride", static_cast<int>(stride));
        // the same area in all
        program.set("u_radius_scale",
                    frame.options.radius_scale * std::sqrt(static_cast<float>(stride)));
        program.set("u_view", frame.view);
        program.set("u_projection", frame.projection);
    }

    [[nodiscard]] std::size_t splat_stride(const Frame& frame) const
    {
        return frame.options.coarse ? upload->splat_count / kCoarseSplats + 1 : 1;
    }
    [[nodiscard]] DrawCall splat_call(const Frame& frame) const
    {
        return {.count = 6 * ((upload->splat_count - 1) / splat_stride(frame) + 1)};
    }

    void set_paint(Program& program, const Frame& frame)
    {
        const bool is_shown = upload->has_paint && frame.options.colors == Colors::textured;
        program.set("u_paint", upload->paint);
        program.set("u_is_painted", is_shown ? 1 : 0);
    }

    void draw_background(const Frame& frame)
    {
        if (frame.options.background) {
            frame.target.clear_color(*frame.options.background);
            return;
        }
        const glm::mat4 to_world = glm::inverse(frame.projection * frame.view);
        background.set("u_show_sky", frame.options.colors == Colors::environment ? 1 : 0);
        background.set("u_exposure", base_exposure * std::exp2(frame.options.exposure));
        background.set("u_sky_frame", sky_frame(frame.camera.up));
        background.set("u_sky", *sky);
        background.set("u_sky_level",
                       std::max(0.0f, std::log2(static_cast<float>(sky->width()) / kSkyBlurWidth)));
        background.set("u_to_world", to_world);
        background.set("u_eye", frame.camera.eye);
        draw_fullscreen(frame.target, background, nothing);
    }

    void set_triangles(Program& program, const Frame& frame)
    {
        set_shading(program, frame);
        set_model_texels(program);
        program.set("u_surfels", upload->surfels);
        program.set("u_wedge_normals", upload->wedge_normals);
        program.set("u_extra_vertices", upload->extra_vertices);
        program.set("u_vertex_count", static_cast<int>(upload->vertex_count));
        program.set("u_view_projection", frame.projection * frame.view);
        set_pixel_values(program, frame.pixels, color_maps.front());
    }

    void draw_triangles(const Frame& frame)
    {
        const bool is_textured = frame.options.colors == Colors::textured;
        if (split.has_layout() || is_textured || frame.options.wireframe) {
            set_triangles(split.program(), frame);
            split.program().set("u_corners", upload->corners);
            split.draw(frame.target, nothing, {is_textured, frame.options.wireframe, frame.cull()});
            return;
        }
        set_triangles(surface, frame);
        const bool is_coarse = frame.options.coarse && upload->coarse;
        draw(frame.target, surface, is_coarse ? upload->coarse->triangles : upload->triangles,
             {.count = is_coarse ? upload->coarse->index_count : upload->index_count,
              .indexed = true},
             {.depth = DepthTest::less, .cull = frame.cull()});
    }

    /// The report's way: nearest splat wins.
    void draw_plain_splats(const Frame& frame, Program& program)
    {
        set_shading(program, frame);
        set_model_texels(program);
        set_splats(program, frame);
        set_paint(program, frame);
        draw(frame.target, program, nothing, splat_call(frame), {.depth = DepthTest::less});
    }

    /// Depth first, a little too far; then the sum of all that is not behind it; then its mean.
    void draw_blended_splats(const Frame& frame)
    {
        if (!splat_target || splat_target->width() != frame.target.width() ||
            splat_target->height() != frame.target.height())
            splat_target.emplace(context, FramebufferOptions{.width = frame.target.width(),
                                                             .height = frame.target.height(),
                                                             .colors = {TexelFormat::rgba32f},
                                                             .depth = true});
        splat_target->clear_color(glm::vec4(0.0f));
        splat_target->clear_depth();
        const DrawCall call = splat_call(frame);

        disk_depth.set("u_positions", upload->positions);
        set_splats(disk_depth, frame);
        disk_depth.set("u_push", kPush);
        draw(*splat_target, disk_depth, nothing, call,
             {.depth = DepthTest::less, .write_color = false});

        set_shading(disks, frame);
        set_model_texels(disks);
        set_splats(disks, frame);
        set_paint(disks, frame);
        draw(*splat_target, disks, nothing, call,
             {.depth = DepthTest::read_only, .blend = Blend::add});

        resolve.set("u_sum", splat_target->color());
        resolve.set("u_depth", splat_target->depth());
        draw_fullscreen(frame.target, resolve, nothing, {.depth = DepthTest::less});
    }

    void draw_model(const Frame& frame)
    {
        if (upload->splat_count == 0)
            return;
        Shape shape =
            split.has_layout() || frame.pixels.own ? Shape::triangles : frame.options.surface;
        if (shape == Shape::triangles && upload->index_count == 0)
            shape = Shape::splats;
        switch (shape) {
            case Shape::triangles:
                draw_triangles(frame);
                break;
            case Shape::splats:
                draw_blended_splats(frame);
                break;
            case Shape::affine:
                draw_plain_splats(frame, affine);
                break;
            case Shape::points:
                draw_plain_splats(frame, points);
                break;
        }
    }

    void draw_ground(const Frame& frame)
    {
        shadow.set("u_corner", upload->ground.corner);
        shadow.set("u_axis_x", upload->ground.axis_x);
        shadow.set("u_axis_y", upload->ground.axis_y);
        shadow.set("u_view_projection", frame.projection * frame.view);
        shadow.set("u_occlusion", *upload->ground_occlusion);
        shadow.set("u_wipe_x", frame.options.colors == Colors::rays
                                   ? 0.0f
                                   : frame.options.wipe * static_cast<float>(frame.target.width()));
        draw(frame.target, shadow, nothing, {.count = 6},
             {.blend = Blend::over, .cull = Cull::back});
    }

    void upload_ground()
    {
        upload->ground_occlusion.emplace(context, kGroundCells + 1, kGroundCells + 1,
                                         TexelFormat::rg32f,
                                         std::span<const glm::vec2>(upload->ground_values),
                                         TextureOptions{.filter = TextureFilter::linear});
    }

    /// channel: 0 = result, 1 = reference. A result alone stands in for the reference.
    void set_values(std::span<const Occlusion> values, TextureBuffer& texels, int channel)
    {
        SURFELAO_CHECK(values.size() == upload->vertex_count + upload->ground_values.size());
        if (upload->vertex_count > 0)
            texels.update(0, std::span<const glm::vec4>(
                                 occlusion_texels(values.first(upload->vertex_count))));
        const std::span<const Occlusion> ground = values.subspan(upload->vertex_count);
        for (std::size_t i = 0; i < ground.size(); ++i) {
            upload->ground_values[i][channel] = ground[i].occlusion;
            if (!upload->reference)
                upload->ground_values[i][1] = ground[i].occlusion;
        }
        upload_ground();
    }

    const GlContext& context;
    Program surface;
    SplitSurface split;
    Program disks, disk_depth, resolve, affine, points, background, shadow;
    VertexArray nothing;
    std::vector<Texture2D> color_maps;
    std::optional<Texture2D> sky, irradiance;
    float base_exposure = 1.0f;
    std::optional<ModelUpload> upload;
    std::optional<Framebuffer> splat_target;
};

Renderer::Renderer(const GlContext& context) : impl_(std::make_unique<Impl>(context))
{
    set_environment(builtin_sky());
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::set_model(const Model& model)
{
    impl_->upload.emplace(impl_->context, model);
    impl_->split.set_model(model);
    impl_->upload_ground();
}

void Renderer::set_shape(const ModelShape& shape)
{
    impl_->upload->move(shape);
}

void Renderer::set_occlusion(std::span<const Occlusion> occlusion)
{
    impl_->set_values(occlusion, impl_->upload->occlusion, 0);
}

void Renderer::set_reference(std::span<const Occlusion> reference)
{
    if (!impl_->upload->reference)
        impl_->upload->reference.emplace(ModelUpload::texels(
            impl_->context, std::vector<glm::vec4>(impl_->upload->vertex_count)));
    impl_->set_values(reference, *impl_->upload->reference, 1);
}

void Renderer::set_layout(const Mesh& mesh, const ModelLayout& layout)
{
    impl_->split.set_layout(mesh, layout);
}

void Renderer::set_map(const ModelMap& map)
{
    impl_->split.set_map(map);
}

void Renderer::set_map_reference(const ModelMap& reference)
{
    impl_->split.set_reference(reference);
}

void Renderer::forget_layout()
{
    impl_->split.forget_layout();
}

void Renderer::set_coarse(std::span<const glm::uvec3> triangles)
{
    impl_->upload->coarse.emplace(impl_->context, triangles);
}

void Renderer::set_paint(const BasePaint& paint)
{
    impl_->split.set_paint(paint);
}

void Renderer::set_environment(const Image& panorama)
{
    const Image irradiance = irradiance_map(panorama);
    impl_->base_exposure = automatic_exposure(irradiance);
    impl_->irradiance =
        upload_image(impl_->context, irradiance,
                     {.filter = TextureFilter::linear, .wrap = TextureWrap::repeat_x});
    impl_->sky = upload_image(impl_->context, shrink_panorama(panorama, kMaxSkyWidth),
                              {.filter = TextureFilter::mipmaps, .wrap = TextureWrap::repeat_x});
}

Framebuffer Renderer::make_target(int width, int height) const
{
    return {impl_->context,
            FramebufferOptions{
                .width = width, .height = height, .colors = {TexelFormat::rgba32f}, .depth = true}};
}

void Renderer::draw_frame(const Framebuffer& target, const Camera& camera,
                          const ViewOptions& options, glm::vec2 shift, const PixelValues& pixels)
{
    SURFELAO_CHECK(impl_->upload.has_value());
    const Impl::Frame frame = impl_->frame_of(target, camera, options, pixels, shift);

    target.clear_depth();
    impl_->draw_background(frame);
    // first: an eye above the ground sees everything of the model before it, one below sees no
    // ground
    if (shows_ground(options))
        impl_->draw_ground(frame);
    impl_->draw_model(frame);
}

void Renderer::draw_values(const Framebuffer& target, const Camera& camera,
                           const ViewOptions& shown, const PixelValues& pixels)
{
    constexpr auto kAsNumbers = static_cast<Colors>(-1);
    const ViewOptions options{.surface = shown.surface, .colors = kAsNumbers, .cull = shown.cull};
    target.clear_color(glm::vec4(0.0f));
    target.clear_depth();
    impl_->draw_model(impl_->frame_of(target, camera, options, pixels, glm::vec2(0.0f)));
}

void Renderer::draw_background(const Framebuffer& target, const Camera& camera,
                               const ViewOptions& options)
{
    const float aspect = static_cast<float>(target.width()) / static_cast<float>(target.height());
    impl_->draw_background({target,
                            camera,
                            options,
                            {},
                            view_matrix(camera),
                            projection_matrix(camera, aspect, 0.1f, 1.0f),
                            {}});
}

}  // namespace surfelao
