#version 330 core
#include "disk_record.glsl"
#include "receiver_grid.glsl"
#include "rows.glsl"
// disks_fit.frag: what each surfel saw on one of its sides, as a linear function of the direction.
//
// Vertices   fullscreen.vert, over rows of records (rows.glsl)
// Drawn by   gpu/gpu_disks.cpp, once per side in each correcting pass
// Reads      u_sums            out_sum of disks_gather.frag, at slots
//            u_blocks_per_row  of u_sums
//            u_records         (disk_record.glsl)
//            u_slots           R32UI: slot of each record; 0xFFFFFFFF: no surfel
//            u_side            +1: the side of the casting normal, -1: the other
//            u_before          out_far of the pass before
//            u_first           1 in the first pass: layers are not told apart yet (disks.h)
//            u_weight          share of the way that the visibility goes
// Writes     out_far           RGBA32F: FarVisibility, slope.xyz constant; nodes: zero
//            out_change        R32F: square of the change of the mean over the hemisphere
// CPU twin   update_visibility in tree/disks/correction.cpp
uniform sampler2D u_sums;
uniform int u_blocks_per_row;
uniform usamplerBuffer u_records;
uniform usamplerBuffer u_slots;
uniform float u_side;
uniform sampler2D u_before;
uniform int u_first;
uniform float u_weight;

layout(location = 0) out vec4 out_far;
layout(location = 1) out float out_change;

void main()
{
    out_far    = vec4(0.0);
    out_change = 0.0;
    ivec2 texel  = ivec2(gl_FragCoord.xy);
    int   record = index_of_texel(texel);
    uint  slot   = texelFetch(u_slots, record).x;
    if (slot == 0xFFFFFFFFu)
        return;
    vec4  sum    = texelFetch(u_sums, pixel_of_slot(int(slot), u_blocks_per_row), 0);
    vec3  normal = u_side * fetch_normal_and_flat_area(u_records, record).xyz;
    vec4  capped = sum / (u_first == 1 ? 1.0 + sum.w : max(1.0, sum.w));
    vec3  mean   = 2.0 / 3.0 * normal;
    vec3  slope  = -4.0 * (capped.xyz - capped.w * mean);
    vec4  found  = vec4(slope, 1.0 - capped.w - dot(slope, mean));
    vec4  step   = u_weight * (found - texelFetch(u_before, texel, 0));
    out_far      = texelFetch(u_before, texel, 0) + step;
    float change = step.w + dot(step.xyz, mean);
    out_change   = change * change;
}
