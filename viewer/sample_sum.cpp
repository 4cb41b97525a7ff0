#include "viewer/sample_sum.h"

#include "gpu/draw.h"
#include "gpu/program.h"
#include "surfels/errors.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace surfelao {

struct SampleSum::Impl {
    Impl(const GlContext& gl, int width, int height)
        : context(gl),
          program(context, "fullscreen.vert", "sum.frag"),
          nothing(context),
          sum(context, FramebufferOptions{
                           .width = width, .height = height, .colors = {TexelFormat::rgba32f}})
    {
    }
    void add(const Texture2D& drawing, int texel)
    {
        program.set("u_image", drawing);
        program.set("u_texel", texel);
        program.set("u_factor", 1.0f);
        program.set("u_encode", 0);
        program.set("u_corner", glm::ivec2(0));
        draw_fullscreen(sum, program, nothing, {.blend = Blend::add});
        ++count;
    }
    const GlContext& context;
    Program program;
    VertexArray nothing;
    Framebuffer sum;
    int count = 0;
};

SampleSum::SampleSum(const GlContext& context, int width, int height)
    : impl_(std::make_unique<Impl>(context, width, height))
{
    clear();
}
SampleSum::~SampleSum() = default;
SampleSum::SampleSum(SampleSum&&) noexcept = default;
SampleSum& SampleSum::operator=(SampleSum&&) noexcept = default;

void SampleSum::clear()
{
    impl_->sum.clear_color(glm::vec4(0.0f));
    impl_->count = 0;
}

int SampleSum::count() const
{
    return impl_->count;
}

void SampleSum::add(const Framebuffer& drawing, int texel)
{
    impl_->add(drawing.color(), texel);
}

void SampleSum::add(const Image& picture)
{
    Image upright = picture;  // row 0 of textures is the bottom
    for (int y = 0; y < upright.height; ++y)
        for (int x = 0; x < upright.width; ++x)
            upright.at(x, y) = picture.at(x, upright.height - 1 - y);
    impl_->add(Texture2D(impl_->context, upright.width, upright.height, TexelFormat::rgba32f,
                         std::span<const glm::vec4>(upright.pixels)),
               1);
}

Image SampleSum::mean() const
{
    SURFELAO_CHECK(impl_->count > 0);
    const std::vector<glm::vec4> texels = impl_->sum.read_color(impl_->sum.rect());
    const auto count = static_cast<float>(impl_->count);
    Image image(impl_->sum.width(), impl_->sum.height());
    for (int y = 0; y < image.height; ++y) {
        const std::size_t row = static_cast<std::size_t>(image.height - 1 - y);
        for (int x = 0; x < image.width; ++x) {
            const glm::vec4& sum =
                texels[row * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)];
            const float opaque = sum.a > 0.0f ? sum.a : 1.0f;  // as colours are premultiplied
            image.at(x, y) = glm::vec4(glm::vec3(sum) / opaque, sum.a / count);
        }
    }
    return image;
}

void SampleSum::show(const Framebuffer& target, glm::ivec2 corner, const Rect& part) const
{
    impl_->program.set("u_image", impl_->sum.color());
    impl_->program.set("u_texel", 1);
    impl_->program.set("u_factor", 1.0f / static_cast<float>(std::max(1, impl_->count)));
    impl_->program.set("u_encode", 1);
    impl_->program.set("u_corner", corner);
    const Rect place = {corner.x, corner.y, impl_->sum.width(), impl_->sum.height()};
    draw_fullscreen(target, impl_->program, impl_->nothing, {.viewport = place, .scissor = part});
}

void SampleSum::show(const Framebuffer& target, glm::ivec2 corner) const
{
    show(target, corner, {corner.x, corner.y, impl_->sum.width(), impl_->sum.height()});
}

}  // namespace surfelao
