/// split_surface.h: a model's triangles with corners of their own on the device, for what lies on
/// them otherwise than at vertices: a map, base colours. For renderer.cpp alone.
#pragma once

#include "gpu/draw.h"
#include "gpu/objects.h"
#include "gpu/program.h"
#include "viewer/base_paint.h"
#include "viewer/model.h"
#include "viewer/model_map.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

class SplitSurface {
public:
    explicit SplitSurface(const GlContext& context);

    /// Another model: without a map, white.
    void set_model(const Model& model);

    /// Where the map lies: open until there is one.
    void set_layout(const Mesh& mesh, const ModelLayout& layout);
    void forget_layout();
    /// Of the layout. Without a reference the result stands in for it.
    void set_map(const ModelMap& map);
    void set_reference(const ModelMap& reference);
    void set_paint(const BasePaint& paint);

    [[nodiscard]] bool has_layout() const { return place_count_ > 0; }

    /// Its uniforms are set by the caller but for what the above have set.
    Program& program() { return program_; }
    struct Look {
        bool paint = false;      ///< else white
        bool wireframe = false;  ///< lines along the edges
        Cull cull = Cull::none;
    };
    /// There is a triangle.
    void draw(const Framebuffer& target, const VertexArray& nothing, const Look& look);

private:
    /// Triangles in sequence of one material.
    struct Run {
        std::size_t first = 0, count = 0;
        glm::vec3 factor{1.0f};
        std::optional<std::uint32_t> picture = {};
    };
    [[nodiscard]] TextureBuffer upload(const ModelMap& map) const;

    const GlContext& context_;
    Program program_;
    int place_count_ = 0;
    MapSize size_{1, 1};
    TextureBuffer places_, facts_, base_places_;
    std::optional<TextureBuffer> map_, reference_;
    std::vector<Texture2D> pictures_;
    Texture2D white_;
    std::vector<Run> runs_;
};

}  // namespace surfelao
