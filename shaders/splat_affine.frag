#version 330 core
#include "shading.glsl"

// splat_affine.frag: a disk cut out of a square under a parallel projection, as in Engleson's report.
//
// It gets too thin at grazing angles and shows single disks: there for comparison with the disks of
// splat_disk.frag.
//
// Vertices   splat_square.vert
// Reads      shading.glsl
//            u_projection  view to clip space
// Writes     out_color     linear, opaque
//            gl_FragDepth  of the disk
//
// Based on:
//   Engleson. Point-based ambient occlusion on the GPU. 2011

uniform mat4 u_projection;

in vec2 v_disk;
flat in vec3 v_view_normal;
flat in float v_center_depth;
flat in float v_radius;
flat in vec4 v_normal_level;
flat in vec4 v_own;
flat in vec4 v_reference;
flat in vec3 v_paint;
out vec4 out_color;

void main()
{
    // the disk's plane over the square, in units of the radius: dz = -(nx/nz) x - (ny/nz) y
    float dz = -dot(v_view_normal.xy, v_disk) / v_view_normal.z;
    if (!(dot(v_disk, v_disk) + dz * dz <= 1.0))
        discard;
    float z = v_center_depth + dz * v_radius;
    gl_FragDepth = 0.5 - 0.5 * (u_projection[2][2] * z + u_projection[3][2]) / z;
    out_color = vec4(v_paint * shade(v_normal_level, v_own, v_reference), 1.0);
}
