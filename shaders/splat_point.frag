#version 330 core
#include "shading.glsl"

// splat_point.frag: a plain point sprite: the whole square.
//
// Vertices   splat_square.vert
// Reads      shading.glsl
// Writes     out_color  linear, opaque

flat in vec4 v_normal_level;
flat in vec4 v_own;
flat in vec4 v_reference;
flat in vec3 v_paint;
out vec4 out_color;

void main() { out_color = vec4(v_paint * shade(v_normal_level, v_own, v_reference), 1.0); }
