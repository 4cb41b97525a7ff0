#version 330 core
#include "shading.glsl"

// splat_disk.frag: a pixel of a surfel's disk, one of several that overlap there.
//
// Vertices   splat_disk.vert
// Reads      shading.glsl
// Writes     out_color = weight * (colour, 1), to be summed over the overlapping disks and divided by
//            the sum of weights (splat_resolve.frag). The weight is a Gaussian of the distance from
//            the disk's centre, in the disk's plane.
//
// Based on:
//   Zwicker, Pfister, van Baar, Gross. Surface Splatting. 2001
//   Botsch, Hornung, Zwicker, Kobbelt. High-Quality Surface Splatting on Today's GPUs. 2005

in vec2 v_disk;
in vec3 v_inside;
flat in vec4 v_normal_level;
flat in vec4 v_own;
flat in vec4 v_reference;
flat in vec3 v_paint;
out vec4 out_color;

void main()
{
    float r2 = dot(v_disk, v_disk);
    if (r2 > 1.0 || any(lessThan(v_inside, vec3(0.0))))
        discard;
    float weight = exp(-3.0 * r2);  // 0.05 at the rim: no visible step, and no pixel without weight
    out_color = weight * vec4(v_paint * shade(v_normal_level, v_own, v_reference), 1.0);
}
