#version 330 core
#include "model_shape.glsl"
#include "model_values.glsl"
#include "splats.glsl"

// splat_disk.vert: a surfel as a square in its own plane.
//
// Drawn by   viewer/renderer.cpp, 6 vertices per splat
// Reads      model_shape.glsl, model_values.glsl, splats.glsl
// Writes     v_disk  place on the square, -1..1 in both directions
//            v_normal_level v_own v_reference: the texels of the surfel's vertex

out vec2 v_disk;
flat out vec4 v_normal_level;
flat out vec4 v_own;
flat out vec4 v_reference;

void main()
{
    int vertex = splat_vertex();
    v_disk = splat_corner();
    v_normal_level = texelFetch(u_normals, vertex);
    v_own = texelFetch(u_occlusion, vertex);
    v_reference = texelFetch(u_reference, vertex);
    vec3 view = disk_corner(texelFetch(u_positions, vertex).xyz, v_normal_level.xyz);
    gl_Position = u_projection * vec4(view, 1.0);
}
