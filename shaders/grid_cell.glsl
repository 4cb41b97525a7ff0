#include "g_buffer.glsl"

// grid_cell.glsl: what is read from an AO grid at the point that a pixel sees, its border included.
//
// Host side  grid/ao_grid.h, pixels/grid_pass.cpp
//   u_to_box        view space to half boxes
//   u_to_grid       directions of view space to those of the grid
//   u_inner u_inner_share  AoGrid: a, s
//   u_cell_scale    .5 (n - 1) / n, per axis: half grids to half textures
//   u_border_value  V_M; below 0: the border fades
//   u_cells         RGBA16F, n^3: m / (4 pi), alpha; SH: coefficients 0 to 3
//   u_cells_2 u_cells_3    SH: 4 to 7, and 8
// CPU twin   read_values(), border_weight() in grid/ao_grid.cpp
uniform mat4 u_to_box;
uniform mat3 u_to_grid;
uniform vec3 u_inner;
uniform float u_inner_share;
uniform vec3 u_cell_scale;
uniform float u_border_value;
uniform sampler3D u_cells;
#ifdef SH
uniform sampler3D u_cells_2;
uniform sampler3D u_cells_3;
#endif

const float kFade = 0.12;  // kGridFade

// no cell where |x| > 1
vec3 place_in_box(ivec2 pixel, vec4 seen)
{
    return (u_to_box * vec4(position_at(pixel, seen), 1.0)).xyz;
}

float farthest_out(vec3 x)
{
    vec3 size = abs(x);
    return max(size.x, max(size.y, size.z));
}

vec3 cell_place(vec3 x)
{
    vec3 size = abs(x);
    vec3 near = u_inner_share * size / u_inner;
    vec3 far = u_inner_share + (1.0 - u_inner_share) * (size - u_inner) / (1.0 - u_inner);
    vec3 u = mix(far, near, lessThan(size, u_inner));
    return 0.5 + sign(x) * u * u_cell_scale;
}

float border_weight(vec3 x, float alpha)
{
    if (u_border_value < 0.0)
        return smoothstep(0.0, kFade, 1.0 - farthest_out(x));
    return max(0.0, alpha - u_border_value) / ((1.0 - u_border_value) * max(alpha, 1e-7));
}

#ifdef SH
// m / (4 pi) and alpha of the first four coefficients
vec4 moments_of(vec4 c) { return vec4(c.w, c.yz, c.x) * vec4(vec3(0.16286750), 0.28209479); }
#endif

// m / (4 pi) in the grid's directions, and alpha
vec4 moments_at(vec3 x)
{
    vec4 moments = texture(u_cells, cell_place(x));
#ifdef SH
    moments = moments_of(moments);
#endif
    return border_weight(x, moments.w) * moments;
}
