/// view_options.h: how a model is shown, without a word on how it is solved.
#pragma once

#include "image/color_map.h"

#include <glm/vec4.hpp>

#include <optional>

namespace surfelao {

/// What stands for the surface.
enum class Shape {
    triangles,  ///< of points: splats
    splats,     ///< surfels as disks: perspective-correct, blended where they overlap
    affine,     ///< surfels as Engleson's report draws them: affinely projected, without blending
    points,     ///< surfels as plain squares that face the camera
};

/// What its colour tells. The numbers are known to shaders/shading.glsl.
enum class Colors {
    visibility = 0,    ///< 1 - occlusion as grey: what baked colours look like elsewhere
    rays = 1,          ///< the same by the ray reference
    difference = 2,    ///< occlusion less the reference, in the colour map
    bent_normals = 3,  ///< x, y, z as red, green, blue
    normals = 4,       ///< likewise: corner normals of triangles, the disks' own of splats
    levels = 5,        ///< depth of the surfel's leaf in the octree, in the colour map
    environment = 6,   ///< light of a panorama along the bent normal, times visibility
    charts = 7,        ///< of a map: a colour for each, times visibility
    density = 8,       ///< of a map: texels per unit of length, in the colour map
    textured = 9,      ///< the surface's own colour times visibility
    coverage = 10,     ///< of cube maps: visibility, red where none of them answers
    radius = 11,       ///< of vo with a dynamic radius: that radius, in the colour map
    headlight = 12,    ///< a light at the eye: Lambert's cosine times visibility
};

struct ViewOptions {
    Shape surface = Shape::triangles;
    Colors colors = Colors::visibility;
    float radius_scale = 1.0f;      ///< > 0, on covering_radii (model.h)
    float difference_scale = 0.1f;  ///< > 0: the difference at the end of the map
    bool is_signed = false;         ///< the difference says which way, in the diverging map
    ColorMap color_map = ColorMap::heat;
    float wipe = 1.0f;       ///< share of the width from which on the reference is shown
    float exposure = 0.0f;   ///< environment: stops, added to the automatic exposure
    bool ground = true;      ///< shadow on the ground under the model
    bool wireframe = false;  ///< triangles: with their edges
    bool cull = false;       ///< triangles: not those that show their back to the eye
    bool coarse = false;     ///< fewer of what is drawn: Renderer::set_coarse()
    /// Behind the model, linear, with an alpha of 0 or 1; empty: a gradient, or the environment.
    std::optional<glm::vec4> background = {};
};

/// The map of their numbers.
[[nodiscard]] constexpr ColorMap map_of(const ViewOptions& options)
{
    return options.is_signed && options.colors == Colors::difference ? ColorMap::diverging
                                                                     : options.color_map;
}

/// Whether drawing this needs a ray reference.
[[nodiscard]] constexpr bool needs_reference(const ViewOptions& options)
{
    return options.colors == Colors::rays || options.colors == Colors::difference ||
           options.wipe < 1.0f;
}

/// Whether they tell of a map; elsewhere they are shown as visibility.
[[nodiscard]] constexpr bool needs_map(Colors colors)
{
    return colors == Colors::charts || colors == Colors::density;
}

/// Whether they are numbers in a colour map.
[[nodiscard]] constexpr bool shows_color_map(const ViewOptions& options)
{
    return options.colors == Colors::difference || options.colors == Colors::levels ||
           options.colors == Colors::density || options.colors == Colors::radius;
}

/// Whether they tell of cube maps.
[[nodiscard]] constexpr bool needs_cube_maps(Colors colors)
{
    return colors == Colors::coverage;
}

/// Whether the ground's shadow is drawn: under colours that tell light.
[[nodiscard]] constexpr bool shows_ground(const ViewOptions& options)
{
    return options.ground &&
           (options.colors == Colors::visibility || options.colors == Colors::rays ||
            options.colors == Colors::environment || options.colors == Colors::textured ||
            options.colors == Colors::headlight);
}

}  // namespace surfelao
