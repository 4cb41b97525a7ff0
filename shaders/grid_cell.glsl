// grid_cell.glsl: what is read from an AO grid at the point that a pixel sees, its border included.
// Without divisions where the host can divide: a pass is bound by arithmetic.
//
// Host side  grid/ao_grid.h, pixels/grid_pass.cpp
//   u_start u_along  a pixel's middle (x, y, 1) to half boxes at distance 0 forward, and what a
//                    distance of 1 adds
//   u_to_grid        directions of view space to those of the grid
//   u_inner          AoGrid: a
//   u_far u_bend     half boxes to half textures: u_far x + u_bend (x cut to [-a, a])
//   u_border         RESCALE: V_M, 1 / (1 - V_M)
//   u_cells          RGBA16F, a texel a cell: m / (4 pi), alpha; SH: coefficients 0 to 3
//   u_surface        as in g_buffer.glsl: normal in view space, distance forward
// CPU twin   read_values(), border_weight() in grid/ao_grid.cpp
uniform mat3 u_start;
uniform mat3 u_along;
uniform mat3 u_to_grid;
uniform vec3 u_inner;
uniform vec3 u_far;
uniform vec3 u_bend;
uniform sampler3D u_cells;
uniform sampler2D u_surface;
#ifdef RESCALE
uniform vec2 u_border;
#endif

const float kFade = 0.12;  // kGridFade

// no cell where |x| > 1
vec3 place_in_box(float distance)
{
    vec3 pixel = vec3(gl_FragCoord.xy, 1.0);
    return u_start * pixel + distance * (u_along * pixel);
}

float farthest_out(vec3 x)
{
    vec3 size = abs(x);
    return max(size.x, max(size.y, size.z));
}

vec3 cell_place(vec3 x) { return 0.5 + u_far * x + u_bend * clamp(x, -u_inner, u_inner); }

float border_weight(vec3 x, float alpha)
{
#ifdef RESCALE
    return max(0.0, alpha - u_border.x) * u_border.y / max(alpha, 1e-7);
#else
    float t = clamp((1.0 - farthest_out(x)) * (1.0 / kFade), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
#endif
}

// m / (4 pi) and alpha of the first four coefficients
vec4 moments_of(vec4 c) { return vec4(c.w, c.yz, c.x) * vec4(vec3(0.16286750), 0.28209479); }

// m / (4 pi) in the grid's directions, and alpha
vec4 moments_at(vec3 x)
{
    vec4 moments = texture(u_cells, cell_place(x));
#ifdef SH
    moments = moments_of(moments);
#endif
    return border_weight(x, moments.w) * moments;
}
