#version 330 core
#include "grid_cell.glsl"
#include "grid_cone.glsl"

// grid_shade.frag: what an object with an AO grid of cones leaves of the light at each pixel.
//
// Vertices   grid_box.vert; blended by multiplication
// Definitions  RESCALE ORTHOGRAPHIC LIFT OWN: GridBorder::rescale, Lens, PlacedGrid::lift,
//            GridPass::draw()
// Reads      grid_cell.glsl, grid_cone.glsl
// Writes     out_visibility  1 - occlusion
// CPU twin   occlusion_at() in grid/ao_grid.cpp

out float out_visibility;

void main()
{
    vec4 seen = texelFetch(u_surface, ivec2(gl_FragCoord.xy), 0);
    vec3 normal = v_to_grid * seen.xyz;
    vec3 x = place_in_box(seen.w, normal);
    if (!(farthest_out(x) <= 1.0) || is_own_pixel())
        discard;
    out_visibility = 1.0 - occlusion_by(moments_at(x), normal);
}
