#version 330 core
#include "model_shape.glsl"
#include "model_values.glsl"
#include "splats.glsl"
#include "splat_paint.glsl"

// splat_disk.vert: a splat as a square in its own plane.
//
// Drawn by   viewer/renderer.cpp, 6 vertices per splat
// Reads      model_shape.glsl, model_values.glsl, splats.glsl, splat_paint.glsl
// Writes     v_disk    place on the square, -1..1 in both directions
//            v_inside  inside_edges of splats.glsl
//            v_normal_level  the disk's normal and level; v_own v_reference v_paint: the
//                     values there

out vec2 v_disk;
out vec3 v_inside;
flat out vec4 v_normal_level;
flat out vec4 v_own;
flat out vec4 v_reference;
flat out vec3 v_paint;

void main()
{
    Splat splat = this_splat();
    v_disk = splat_corner();
    v_normal_level = vec4(splat_normal(splat), value_at(splat, u_surfels).w);
    v_own = value_at(splat, u_occlusion);
    v_reference = value_at(splat, u_reference);
    v_paint = splat_paint(splat);
    vec3 corner = disk_corner(splat);
    v_inside = inside_edges(splat, corner);
    gl_Position = u_projection * u_view * vec4(corner, 1.0);
}
