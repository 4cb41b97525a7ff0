#version 330 core
#include "dynamic_radius.glsl"

// dynamic_radius.frag: the radius that a rule chooses, as a share of R; 0 on the background.
//
// Vertices   fullscreen.vert
// Reads      dynamic_radius.glsl
// Writes     out_share
out float out_share;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(u_surface, pixel, 0);
    out_share = is_background(here) ? 0.0 : chosen_radius(position_at(pixel, here)) / u_radius;
}
