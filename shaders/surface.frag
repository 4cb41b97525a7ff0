#version 330 core
#include "shading.glsl"
#include "pixel_values.glsl"

// surface.frag: a triangle's pixel.
//
// Vertices   surface.vert
// Reads      shading.glsl, pixel_values.glsl
// Writes     out_color  linear, opaque

in vec4 v_normal_level;
in vec4 v_own;
in vec4 v_reference;
out vec4 out_color;

void main()
{
    vec4 own = v_own;
    vec4 reference = v_reference;
    read_pixels(own, reference, v_normal_level.xyz);
    out_color = vec4(is_hole(u_colors) ? kHole : shade(v_normal_level, own, reference), 1.0);
}
