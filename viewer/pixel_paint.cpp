#include "viewer/pixel_paint.h"

#include "surfels/errors.h"
#include "surfels/srgb.h"
#include "viewer/environment.h"
#include "viewer/renderer.h"
#include "viewer/shown_error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

constexpr float kAlbedo = 0.80f;          // of the model in the environment, as in shading.glsl
constexpr float kPaperValue = 0.94f;      // shown value of an open place, likewise
constexpr int kLargestBackground = 2048;  // pixels each way: it is smooth, and stretched beyond

glm::vec3 direction_number(glm::vec3 direction)
{
    return 0.5f + 0.5f * direction;
}

/// Light from all around, along a bent normal; with AO grids, less what comes out of the cones that
/// the objects hide.
class SkyLight {
public:
    SkyLight(const ViewOptions& options, glm::vec3 up, const Image* panorama)
        : SkyLight(options, up, panorama ? *panorama : builtin_sky())
    {
    }
    [[nodiscard]] glm::vec3 operator()(const AnsweredPixel& pixel) const
    {
        // methods that know no bent normal leave the receiver's own
        const glm::vec3 bent = pixel.value.bent_normal == glm::vec3(0.0f) ? pixel.receiver.normal
                                                                          : pixel.value.bent_normal;
        const glm::vec3 light(sample_panorama(irradiance_, panorama_uv(frame_ * bent)));
        return soften(
            kAlbedo * exposure_ *
            (pixel.grids ? left_by_grids(pixel, light) : (1.0f - pixel.value.occlusion) * light));
    }

private:
    SkyLight(const ViewOptions& options, glm::vec3 up, const Image& panorama)
        : irradiance_(irradiance_map(panorama)),
          halves_(halved_panoramas(panorama)),
          frame_(sky_frame(up)),
          exposure_(automatic_exposure(irradiance_) * std::exp2(options.exposure))
    {
    }
    /// (1 - occlusion by the rest and the object itself) (B - A): B the light of the hemisphere, A
    /// what the cones' patches of the panorama would send, weighed so that together they take what
    /// all other objects take.
    [[nodiscard]] glm::vec3 left_by_grids(const AnsweredPixel& pixel, glm::vec3 light) const
    {
        const Receiver& at = pixel.receiver;
        float visible = 1.0f, sum = 0.0f;
        glm::vec3 taken(0.0f);
        for (const TakenLight& one : taken_at(pixel.grids->world->objects(), pixel.grids->merge,
                                              at.position, at.normal, pixel.surface)) {
            const glm::vec3 mean(one.moments);
            const float length = glm::length(mean);
            const glm::vec3 axis = length > 0.0f ? mean / length : at.normal;
            visible *= 1.0f - one.occlusion;
            sum += one.occlusion;
            taken += one.occlusion * patch_light(halves_, frame_ * axis, one.moments.w);
        }
        if (!(sum > 0.0f) || !(visible > 0.0f))
            return (1.0f - pixel.value.occlusion) * light;
        return (1.0f - pixel.value.occlusion) / visible *
               glm::max(light - (1.0f - visible) / sum * taken, 0.0f);
    }

    Image irradiance_;
    std::vector<Image> halves_;
    glm::mat3 frame_;
    float exposure_;
};

}  // namespace

PixelPaint pixel_paint(const ViewOptions& options, const Camera& camera, const Image* panorama,
                       const BasePaint* paint)
{
    const auto visibility = [](const AnsweredPixel& pixel) {
        return glm::vec3(1.0f - pixel.value.occlusion);
    };
    switch (options.colors) {
        case Colors::rays:
            return {[](const AnsweredPixel& pixel) {
                return glm::vec3(1.0f - pixel.reference.occlusion);
            }};
        case Colors::difference:
            return {[](const AnsweredPixel& pixel) {
                return glm::vec3(pixel.value.occlusion, pixel.reference.occlusion, 0.0f);
            }};
        case Colors::bent_normals:
            return {[](const AnsweredPixel& pixel) {
                return direction_number(pixel.value.bent_normal);
            }};
        case Colors::normals:
            return {
                [](const AnsweredPixel& pixel) { return direction_number(pixel.receiver.normal); }};
        case Colors::environment:
            return {SkyLight(options, camera.up, panorama)};
        case Colors::headlight:
            return {[eye = camera.eye](const AnsweredPixel& pixel) {
                const Receiver& at = pixel.receiver;
                const float facing =
                    std::abs(glm::dot(at.normal, glm::normalize(eye - at.position)));
                return glm::vec3(srgb_decode(kPaperValue) * (1.0f - pixel.value.occlusion) *
                                 facing);
            }};
        case Colors::textured:
            SURFELAO_CHECK(paint != nullptr);
            return {visibility,
                    [paint](const SurfacePoint& point) { return paint_at(*paint, point); }};
        case Colors::coverage:
            return {[](const AnsweredPixel& pixel) {
                return pixel.is_hole ? glm::vec3(1.0f, 0.0f, 0.0f)
                                     : glm::vec3(1.0f - pixel.value.occlusion);
            }};
        default:
            return {visibility};
    }
}

void show_numbers(Image& image)
{
    for (glm::vec4& pixel : image.pixels) {
        for (int c = 0; c < 3; ++c)
            pixel[c] = srgb_decode(pixel[c]);
    }
}

void show_difference(Image& image, ViewOptions options, bool fit_scale)
{
    const ErrorStatistics error = shown_error(image.pixels);
    if (fit_scale)
        options.difference_scale = fitting_scale(error);
    const ColorMap map = map_of(options);
    for (glm::vec4& pixel : image.pixels)
        if (pixel.a > 0.0f)
            pixel = glm::vec4(
                map_color(map, difference_place(map, pixel.r - pixel.g, options.difference_scale)),
                pixel.a);
    Legend legend = difference_legend(options);
    legend.note = note_of(error);
    draw_legend(image, legend);
}

void put_on_background(const GlContext& context, Image& image, const Camera& camera,
                       const ViewOptions& options, const Image* panorama)
{
    Renderer renderer(context);
    if (panorama)
        renderer.set_environment(*panorama);
    const int width = std::min(image.width, kLargestBackground);
    const int height = std::min(image.height, kLargestBackground);
    const Framebuffer target = renderer.make_target(width, height);
    renderer.draw_background(target, camera, options);
    const std::vector<glm::vec4> background = target.read_color(target.rect());
    for (int y = 0; y < image.height; ++y) {
        const int row = height - 1 - y * height / image.height;  // row 0 of targets is the bottom
        for (int x = 0; x < image.width; ++x) {
            const int column = x * width / image.width;
            glm::vec4& pixel = image.at(x, y);
            pixel = glm::vec4(
                glm::mix(glm::vec3(background[static_cast<std::size_t>(row * width + column)]),
                         glm::vec3(pixel), pixel.a),
                1.0f);
        }
    }
}

}  // namespace surfelao
