#version 330 core
#include "model_shape.glsl"
#include "splats.glsl"

// splat_depth.vert: the square of splat_disk.vert, a little farther from the eye.
//
// Drawn by   viewer/renderer.cpp, 6 vertices per splat
// Reads      model_shape.glsl, splats.glsl
//            u_push  by which share of the radius
// Writes     v_disk    place on the square, -1..1 in both directions
//            v_inside  inside_edges of splats.glsl

uniform float u_push;

out vec2 v_disk;
out vec3 v_inside;

void main()
{
    Splat splat = this_splat();
    v_disk = splat_corner();
    vec3 corner = disk_corner(splat);
    v_inside = inside_edges(splat, corner);
    vec3 view = (u_view * vec4(corner, 1.0)).xyz;
    // along the ray, so that nothing moves on the screen
    view += view * (u_push * splat_radius() / max(length(view), 1e-6));
    gl_Position = u_projection * vec4(view, 1.0);
}
