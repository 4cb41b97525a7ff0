#include "viewer/split_surface.h"

#include "image/color_map.h"
#include "surfels/errors.h"
#include "surfels/srgb.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace surfelao {
namespace {

constexpr std::size_t kBlendedPlaces = 3;

std::uint32_t as_byte(float value)
{
    return static_cast<std::uint32_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// red, green, blue, alpha from the lowest byte on
std::uint32_t packed(glm::vec4 color)
{
    return as_byte(color.r) | as_byte(color.g) << 8 | as_byte(color.b) << 16 |
           as_byte(color.a) << 24;
}

std::uint32_t shown_color(glm::vec3 linear, float alpha = 1.0f)
{
    return packed({srgb_encode(linear.r), srgb_encode(linear.g), srgb_encode(linear.b), alpha});
}

Texture2D upload_picture(const GlContext& context, const Image& picture)
{
    std::vector<std::uint32_t> texels;
    texels.reserve(picture.pixels.size());
    for (const glm::vec4& pixel : picture.pixels)
        texels.push_back(shown_color(glm::vec3(pixel), pixel.a));
    return {context,
            picture.width,
            picture.height,
            TexelFormat::srgb8_alpha8,
            std::span<const std::uint32_t>(texels),
            {.filter = TextureFilter::mipmaps, .wrap = TextureWrap::repeat}};
}

}  // namespace

SplitSurface::SplitSurface(const GlContext& context)
    : context_(context),
      program_(context, "split_surface.vert", "split_surface.frag"),
      places_(context, TexelFormat::rg32f, std::size_t{1}),
      facts_(context, TexelFormat::rgba32ui, std::size_t{1}),
      base_places_(context, TexelFormat::rg32f, std::size_t{1}),
      white_(upload_picture(context, Image(1, 1, glm::vec4(1.0f))))
{
}

void SplitSurface::set_model(const Model& model)
{
    forget_layout();
    pictures_.clear();
    runs_ = {{.count = model.geometry().triangles.size()}};
    base_places_ = {context_, TexelFormat::rg32f, 3 * runs_[0].count};
}

void SplitSurface::forget_layout()
{
    place_count_ = 0;
    map_.reset();
    reference_.reset();
}

void SplitSurface::set_layout(const Mesh& mesh, const ModelLayout& shown)
{
    const MapLayout& layout = shown.layout;
    const std::size_t count = layout.is_blended ? kBlendedPlaces : 1;
    const auto triangles = static_cast<std::uint32_t>(mesh.geometry.triangles.size());
    std::vector<glm::vec2> places(3 * count * triangles, glm::vec2(0.0f));
    std::vector<glm::uvec4> facts(count * triangles, glm::uvec4(0));
    for (std::uint32_t page = 0; page < layout.pages.size(); ++page) {
        const std::size_t slot = layout.is_blended ? page : 0;
        for (std::uint32_t t = 0; t < triangles; ++t) {
            const std::uint32_t chart = shown.facts.charts[page][t];
            glm::uvec4& of_triangle = facts[count * t + slot];
            if (chart == LayoutFacts::kNone || of_triangle.x != 0)
                continue;
            const float density = shown.facts.densities[page][t] / most_density(shown.facts);
            of_triangle = {page + 1, shown_color(label_color(chart), 0.0f),
                           std::bit_cast<std::uint32_t>(density), 0};
            for (std::size_t k = 0; k < 3; ++k)
                places[count * (3 * t + k) + slot] =
                    *uv_at(mesh.geometry, layout.pages[page],
                           {t, {k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f}});
        }
    }
    places_ = {context_, TexelFormat::rg32f, std::span<const glm::vec2>(places)};
    facts_ = {context_, TexelFormat::rgba32ui, std::span<const glm::uvec4>(facts)};
    place_count_ = static_cast<int>(count);
    size_ = layout.size;
    reference_.reset();
    map_.emplace(upload(open_map(layout)));
}

TextureBuffer SplitSurface::upload(const ModelMap& map) const
{
    std::vector<std::uint32_t> texels;
    texels.reserve(map.visibility.size() * size_.count());
    for (std::size_t page = 0; page < map.visibility.size(); ++page) {
        const std::vector<float>& visibility = map.visibility[page].values;
        const std::vector<float>& bent = map.bent[page].values;
        SURFELAO_CHECK(visibility.size() == size_.count() && bent.size() == 3 * size_.count());
        for (std::size_t i = 0; i < visibility.size(); ++i)
            texels.push_back(
                packed({bent[3 * i], bent[3 * i + 1], bent[3 * i + 2], visibility[i]}));
    }
    return {context_, TexelFormat::rgba8, std::span<const std::uint32_t>(texels)};
}

void SplitSurface::set_map(const ModelMap& map)
{
    map_.emplace(upload(map));
}

void SplitSurface::set_reference(const ModelMap& reference)
{
    reference_.emplace(upload(reference));
}

void SplitSurface::set_paint(const BasePaint& paint)
{
    pictures_.clear();
    for (const Image& picture : paint.pictures)
        pictures_.push_back(upload_picture(context_, picture));
    runs_.clear();
    for (std::size_t first = 0, end = 0; first < paint.triangles.size(); first = end) {
        while (end < paint.triangles.size() && paint.triangles[end] == paint.triangles[first])
            ++end;
        const BaseColor& material = paint.materials[paint.triangles[first]];
        runs_.push_back({first, end - first, material.factor, material.picture});
    }
    base_places_ = {context_, TexelFormat::rg32f, std::span<const glm::vec2>(paint.places)};
}

void SplitSurface::draw(const Framebuffer& target, const VertexArray& nothing, const Look& look)
{
    const TextureBuffer& map = map_ ? *map_ : places_;
    program_.set("u_wireframe", look.wireframe ? 1 : 0);
    program_.set("u_place_count", place_count_);
    program_.set("u_places", places_);
    program_.set("u_facts", facts_);
    program_.set("u_base_places", base_places_);
    program_.set("u_map", map);
    program_.set("u_map_reference", reference_ ? *reference_ : map);
    program_.set("u_map_size", glm::ivec2(size_.width, size_.height));
    const Run whole{.count = runs_.back().first + runs_.back().count};
    for (const Run& run : look.paint ? std::span<const Run>(runs_) : std::span(&whole, 1)) {
        program_.set("u_first_corner", static_cast<int>(3 * run.first));
        program_.set("u_base_factor", run.factor);
        program_.set("u_base", run.picture ? pictures_[*run.picture] : white_);
        surfelao::draw(target, program_, nothing, {.count = 3 * run.count},
                       {.depth = DepthTest::less, .cull = look.cull});
    }
}

}  // namespace surfelao
