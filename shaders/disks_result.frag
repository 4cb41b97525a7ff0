#version 330 core
#include "bent_normal.glsl"
#include "receiver_grid.glsl"
#include "rows.glsl"
// disks_result.frag: occlusion and bent normal of each receiver from its sums, in the receivers' order.
//
// Vertices   fullscreen.vert, over rows of receivers (rows.glsl)
// Drawn by   gpu/gpu_disks.cpp
// Reads      u_sums            out_sum of disks_gather.frag, at slots
//            u_blocks_per_row  of u_sums
//            u_receivers       RGBA32F, 2 texels a slot: position.xyz 0 | normal.xyz 0
//            u_slots           R32UI: slot of each receiver; 0xFFFFFFFF: it has no normal
//            u_strength        as DiskOptions::strength
// Writes     out_result        RGBA32F: bent normal | occlusion (surfels/occlusion.h)
// CPU twin   to_occlusion in tree/disks/disks.cpp
uniform sampler2D u_sums;
uniform int u_blocks_per_row;
uniform samplerBuffer u_receivers;
uniform usamplerBuffer u_slots;
uniform float u_strength;

out vec4 out_result;

void main()
{
    out_result = vec4(0.0);
    uint slot  = texelFetch(u_slots, index_of_texel(ivec2(gl_FragCoord.xy))).x;
    if (slot == 0xFFFFFFFFu)
        return;
    vec4  sum    = texelFetch(u_sums, pixel_of_slot(int(slot), u_blocks_per_row), 0);
    vec3  normal = texelFetch(u_receivers, int(slot) * 2 + 1).xyz;
    vec4  capped = sum / max(1.0, sum.w);
    vec3  open   = 2.0 / 3.0 * normal - capped.xyz;
    out_result.xyz = capped.w < 1.0 ? bent_normal_of(open, normal) : normal;
    out_result.w   = clamp(u_strength * sum.w, 0.0, 1.0);
}
