#version 330 core
#include "grid_cone.glsl"

// grid_union.frag: what the joined cones of all objects leave of the light at each pixel.
//
// Vertices   fullscreen.vert
// Definitions  OWN: GridPass::draw()
// Reads      grid_cone.glsl
//            u_surface  as in g_buffer.glsl: the normal in view space
//            u_before  as grid_merge.frag writes it
//            u_own  OWN: as in grid_cell.glsl
// Writes     out_visibility  1 - occlusion

uniform sampler2D u_before;
uniform sampler2D u_surface;
#ifdef OWN
uniform sampler2D u_own;
#endif

out float out_visibility;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 normal = texelFetch(u_surface, pixel, 0).xyz;
    out_visibility = 1.0 - occlusion_by(texelFetch(u_before, pixel, 0), normal);
#ifdef OWN
    out_visibility *= texelFetch(u_own, pixel, 0).r;
#endif
}
