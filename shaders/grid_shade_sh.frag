#version 330 core
#include "grid_cell.glsl"

// grid_shade_sh.frag: what an object with an AO grid of harmonics leaves of the light at each pixel.
//
// Vertices   grid_box.vert; blended by multiplication
// Definitions  RESCALE ORTHOGRAPHIC LIFT OWN: GridBorder::rescale, Lens, PlacedGrid::lift,
//            GridPass::draw()
// Reads      grid_cell.glsl: u_cells has the coefficients 0 to 3
//            u_cells_2 u_cells_3  RGBA16F, a texel a cell: 4 to 7, and 8
// Writes     out_visibility  1 - occlusion
// CPU twin   occlusion_at() in grid/ao_grid.cpp

uniform sampler3D u_cells_2;
uniform sampler3D u_cells_3;

out float out_visibility;

// cosine_weight() times harmonics_along(), by the coefficients
float occlusion_at(vec3 x, vec3 n)
{
    vec3 place = cell_place(x);
    vec4 first = texture(u_cells, place);
    vec4 second = texture(u_cells_2, place);
    float last = texture(u_cells_3, place).r;
    const float kBand1 = 2.0 / 3.0 * 0.48860251;
    const float kBand2 = 0.25 * 1.09254843;
    float sum = 0.28209479 * first.x + kBand1 * dot(first.yzw, n.yzx) +
                kBand2 * dot(second.xyw, n.xyx * n.yzz) +
                0.25 * 0.31539157 * (3.0 * n.z * n.z - 1.0) * second.z +
                0.25 * 0.54627422 * (n.x * n.x - n.y * n.y) * last;
    return clamp(border_weight(x, moments_of(first).w) * sum, 0.0, 1.0);
}

void main()
{
    vec4 seen = texelFetch(u_surface, ivec2(gl_FragCoord.xy), 0);
    vec3 normal = v_to_grid * seen.xyz;
    vec3 x = place_in_box(seen.w, normal);
    if (!(farthest_out(x) <= 1.0) || is_own_pixel())
        discard;
    out_visibility = 1.0 - occlusion_at(x, normal);
}
