// grid_cell.glsl: what is read from an AO grid at the point that a pixel sees, its border included.
// Without divisions where the host can divide: a pass is bound by arithmetic.
//
// Host side  grid/ao_grid.h, pixels/grid_pass.cpp
//   v_...      the uniforms of grid_box.vert
//   u_border   RESCALE: V_M, 1 / (1 - V_M)
//   u_lift     LIFT: PlacedGrid::lift in half boxes
//   u_cells    RGBA16F, a texel a cell: m / (4 pi), alpha; SH: coefficients 0 to 3
//   u_surface  as in g_buffer.glsl: normal in view space, distance forward
//   u_own      OWN: RG32F: what the surface that the pixel looks at leaves of the light by itself,
//              and its number
//   u_number   OWN: of the surface of the object whose grid this is
// CPU twin   read_values(), border_weight() in grid/ao_grid.cpp
flat in mat3 v_across;
flat in vec3 v_rest;
flat in mat3 v_to_grid;
flat in vec3 v_inner;
flat in vec3 v_far;
flat in vec3 v_bend;
uniform sampler3D u_cells;
uniform sampler2D u_surface;
#ifdef RESCALE
uniform vec2 u_border;
#endif
#ifdef LIFT
uniform vec3 u_lift;
#endif
#ifdef OWN
uniform sampler2D u_own;
uniform float u_number;
#endif

const float kFade = 0.12;  // kGridFade

// no cell where |x| > 1; normal: in the grid's directions
vec3 place_in_box(float distance, vec3 normal)
{
    vec3 across = v_across * vec3(gl_FragCoord.xy, 1.0);
#ifdef ORTHOGRAPHIC
    vec3 place = across + distance * v_rest;
#else
    vec3 place = distance * across + v_rest;
#endif
#ifdef LIFT
    place += u_lift * normal;
#endif
    return place;
}

// of the object's own surface: what it hides from itself its cells are too coarse to tell
bool is_own_pixel()
{
#ifdef OWN
    return texelFetch(u_own, ivec2(gl_FragCoord.xy), 0).g == u_number;
#else
    return false;
#endif
}

float farthest_out(vec3 x)
{
    vec3 size = abs(x);
    return max(size.x, max(size.y, size.z));
}

vec3 cell_place(vec3 x) { return 0.5 + v_far * x + v_bend * clamp(x, -v_inner, v_inner); }

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
