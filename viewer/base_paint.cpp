#include "viewer/base_paint.h"

#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/texels.h"

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

/// Linear between the four pixels whose centres are around uv, repeating.
glm::vec3 sample_repeating(const Image& picture, glm::vec2 uv)
{
    const glm::ivec2 size(picture.width, picture.height);
    const glm::vec2 place = glm::fract(uv) * glm::vec2(size) - 0.5f;
    const glm::vec2 low = glm::floor(place), share = place - low;
    const glm::ivec2 a = (glm::ivec2(low) + size) % size, b = (a + 1) % size;
    return glm::mix(
        glm::mix(glm::vec3(picture.at(a.x, a.y)), glm::vec3(picture.at(b.x, a.y)), share.x),
        glm::mix(glm::vec3(picture.at(a.x, b.y)), glm::vec3(picture.at(b.x, b.y)), share.x),
        share.y);
}

}  // namespace

BasePaint base_paint_of(const Mesh& mesh)
{
    const Geometry& geometry = mesh.geometry;
    BaseColors colors = mesh.scene.asset ? mesh.scene.asset->base_colors() : BaseColors{};
    BasePaint paint;
    if (colors.triangles.size() != mesh.scene.triangles.size())
        colors = {.materials = {{}},
                  .triangles = std::vector<std::uint32_t>(mesh.scene.triangles.size())};
    std::vector<std::optional<std::uint32_t>> read;  // per picture of the file
    for (const PictureSource& source : colors.pictures) {
        try {
            paint.pictures.push_back(source.file.empty() ? read_image(source.name, source.bytes)
                                                         : read_image(source.file));
            read.emplace_back(static_cast<std::uint32_t>(paint.pictures.size() - 1));
        } catch (const InputError& error) {
            paint.notes.emplace_back(error.what());
            read.emplace_back();
        }
    }
    for (BaseColor& material : colors.materials) {
        if (material.picture)
            material.picture = read[*material.picture];
    }
    paint.materials = std::move(colors.materials);
    paint.triangles.reserve(geometry.triangles.size());
    paint.places.reserve(3 * geometry.triangles.size());
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
        paint.triangles.push_back(colors.triangles[geometry.scene_triangle(t)]);
        const std::uint32_t set = paint.materials[paint.triangles.back()].uv_set;
        for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
            std::optional<glm::dvec2> at;
            if (set < mesh.scene.uvs.size() && !mesh.scene.uvs[set].empty())
                at = uv_at(geometry, mesh.scene.uvs[set], {t, corner});
            const BaseColor& material = paint.materials[paint.triangles.back()];
            paint.places.emplace_back(material.uv_matrix * at.value_or(glm::dvec2(0.0)) +
                                      material.uv_offset);
        }
    }
    return paint;
}

glm::vec3 paint_at(const BasePaint& paint, const SurfacePoint& point)
{
    const BaseColor& material = paint.materials[paint.triangles[point.triangle]];
    if (!material.picture)
        return material.factor;
    const glm::vec2* const corners = &paint.places[3 * std::size_t{point.triangle}];
    const glm::vec2 uv = (1.0f - point.at.x - point.at.y) * corners[0] + point.at.x * corners[1] +
                         point.at.y * corners[2];
    return material.factor * sample_repeating(paint.pictures[*material.picture], uv);
}

}  // namespace surfelao
