/// model_upload.h: a model's own data on the device; for renderer.cpp alone.
#pragma once

#include "gpu/context.h"
#include "gpu/objects.h"
#include "surfels/errors.h"
#include "viewer/model.h"
#include "viewer/model_pose.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Empty buffers are an error of the device: a scene without area draws one unused element instead.
template <class T>
std::vector<T> at_least_one(std::vector<T> values)
{
    if (values.empty())
        values.emplace_back();
    return values;
}

/// Triangles of a model that stand for all of them.
struct CoarseTriangles {
    CoarseTriangles(const GlContext& context, std::span<const glm::uvec3> wedges)
        : corners(context, TexelFormat::r32ui, wedges),
          triangles(context),
          index_count(3 * wedges.size())
    {
        triangles.indices(corners.buffer());
    }
    TextureBuffer corners;
    VertexArray triangles;
    std::size_t index_count;
};

/// What depends on the model alone.
struct ModelUpload {
    ModelUpload(const GlContext& context, const Model& model)
        : ModelUpload(context, model, own_colors(model))
    {
    }
    ModelUpload(const GlContext& context, const Model& model, const std::vector<glm::vec4>& own)
        : positions(texels(context, model.geometry().positions)),
          surfel_values(surfel_texels(model)),
          surfels(texels(context, surfel_values)),
          wedge_normals(texels(context, model.mesh->surface.normals)),
          extra_vertices(context, TexelFormat::r32ui,
                         view(at_least_one(model.mesh->surface.extra_vertices))),
          occlusion(texels(context, open(model))),
          splats(context, TexelFormat::rgba32ui, view(at_least_one(model.splats))),
          paint(texels(context, own)),
          has_paint(!own.empty()),
          radii(context, TexelFormat::r32f, view(at_least_one(model.splat_radii))),
          corners(context, TexelFormat::r32ui,
                  view(at_least_one(model.mesh->surface.corners(model.geometry())))),
          triangles(context),
          index_count(3 * model.geometry().triangles.size()),
          splat_count(model.splats.size()),
          ground(model.ground)
    {
        triangles.indices(corners.buffer());
        vertex_count = model.geometry().positions.size();
        radius = radius_of(model.seen, model.splat_radii);
    }

    /// Of a ball about the origin that holds all that is drawn.
    float radius_of(const std::vector<glm::vec3>& seen, const std::vector<float>& splat_radii) const
    {
        float most = 0.0f;
        for (const glm::vec3& p : seen)
            most = std::max(most, glm::length(p));
        most = std::max({most, glm::length(ground.corner),
                         glm::length(ground.corner + ground.axis_x + ground.axis_y),
                         glm::length(ground.corner + ground.axis_x),
                         glm::length(ground.corner + ground.axis_y)});
        if (!splat_radii.empty())
            most += *std::max_element(splat_radii.begin(), splat_radii.end());
        return most;
    }

    void move(const ModelShape& shape)
    {
        SURFELAO_CHECK(shape.positions.size() == vertex_count);
        for (std::size_t v = 0; v < shape.normals.size(); ++v)
            surfel_values[v] = glm::vec4(shape.normals[v], surfel_values[v].w);
        positions.update(0, view(padded(shape.positions)));
        surfels.update(0, view(surfel_values));
        wedge_normals.update(0, view(padded(shape.wedge_normals)));
        if (!shape.splat_radii.empty())
            radii.update(0, view(shape.splat_radii));
        radius = radius_of(shape.positions, shape.splat_radii);
    }

    template <class T>
    static std::span<const T> view(const std::vector<T>& values)
    {
        return values;
    }
    static TextureBuffer texels(const GlContext& context, const std::vector<glm::vec4>& values)
    {
        return {context, TexelFormat::rgba32f, view(at_least_one(values))};
    }
    static std::vector<glm::vec4> padded(const std::vector<glm::vec3>& values)
    {
        std::vector<glm::vec4> texels;
        texels.reserve(values.size());
        for (const glm::vec3& value : values)
            texels.emplace_back(value, 0.0f);
        return texels;
    }
    static TextureBuffer texels(const GlContext& context, const std::vector<glm::vec3>& values)
    {
        return texels(context, padded(values));
    }
    /// One per vertex: the surfel's own normal, and its level.
    static std::vector<glm::vec4> surfel_texels(const Model& model)
    {
        const Geometry& geometry = model.geometry();
        std::vector<float> level_at(geometry.positions.size(), 0.0f);
        const glm::vec2 range = level_range(model);
        for (std::size_t i = 0; i < model.surfels.size(); ++i)
            level_at[model.surfels[i]] = (model.levels[i] - range.x) / (range.y - range.x);
        std::vector<glm::vec4> values;
        values.reserve(level_at.size());
        for (std::size_t v = 0; v < level_at.size(); ++v)
            values.emplace_back(geometry.normals[v], level_at[geometry.welded[v]]);
        return values;
    }
    /// Of points; meshes have a BasePaint. Empty where there are none.
    static std::vector<glm::vec4> own_colors(const Model& model)
    {
        if (!model.cloud || !model.mesh->scene.asset)
            return {};
        return model.mesh->scene.asset->own_colors();
    }
    static std::vector<glm::vec4> open(const Model& model)
    {
        std::vector<glm::vec4> values;
        const Surface& surface = model.mesh->surface;
        values.reserve(surface.vertex_count());
        for (std::size_t v = 0; v < surface.vertex_count(); ++v)
            values.emplace_back(surface.normals[v], 0.0f);
        return values;
    }

    TextureBuffer positions;
    std::vector<glm::vec4> surfel_values;  ///< what lies in the next
    TextureBuffer surfels, wedge_normals, extra_vertices, occlusion;
    std::optional<TextureBuffer> reference;
    TextureBuffer splats, paint;
    bool has_paint;
    TextureBuffer radii, corners;
    VertexArray triangles;
    std::optional<CoarseTriangles> coarse;
    std::size_t vertex_count = 0, index_count, splat_count;
    ShadowSquare ground;
    float radius = 0.0f;  ///< radius_of()
    std::optional<Texture2D> ground_occlusion;
    std::vector<glm::vec2> ground_values =
        std::vector<glm::vec2>(kGroundReceivers, glm::vec2(0.0f));
};

}  // namespace surfelao
