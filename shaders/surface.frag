#version 330 core
#include "shading.glsl"

// surface.frag: a triangle's pixel.
//
// Vertices   surface.vert
// Reads      shading.glsl
// Writes     out_color  linear, opaque

in vec4 v_normal_level;
in vec4 v_own;
in vec4 v_reference;
out vec4 out_color;

void main() { out_color = vec4(shade(v_normal_level, v_own, v_reference), 1.0); }
