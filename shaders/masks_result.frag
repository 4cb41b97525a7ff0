#version 330 core
#include "mask_constants.glsl"
#include "receiver_grid.glsl"
#include "rows.glsl"
// masks_result.frag: occlusion and bent normal of each slot from the sums over all faces. Where much
// is covered cracks count as filled, by degrees; where nearly all is, those beside narrow clusters
// and those of two bits too.
//
// Vertices   fullscreen.vert, over the part of the rows of all slots (rows.glsl) that is computed
// Drawn by   gpu/gpu_masks.cpp, once per distance limit, added by blending
// Definitions  GROUND: 0 or 1. There is a ground
// Reads      u_share, u_bent, u_bent_filled, u_bent_closed
//                              outputs of masks_face.frag, summed over the faces
//            u_weight          of the limit
//            u_fill_from       occlusion from which cracks count
//            u_close           how much cracks of two bits count as closed
//            u_slot_count, u_blocks_per_row  (receiver_grid.glsl)
//            u_first_slot      before those that are computed
//            u_skies           RG32F, one a slot that is computed: share of the hemisphere that the
//                              ground leaves | of masks_face.frag                      (GROUND)
// Writes     out_result      RGBA32F, times u_weight: bent normal, mask frame, any length, zero where all is closed |
//                            occlusion (surfels/occlusion.h)
// CPU twin   openness_of in tree/masks/kernel_solve.h
#ifndef GROUND
#define GROUND 0
#endif

uniform sampler2D u_share;
uniform sampler2D u_bent;
uniform sampler2D u_bent_filled;
uniform sampler2D u_bent_closed;
uniform float u_weight;
uniform float u_fill_from;
uniform float u_close;
uniform int u_slot_count;
uniform int u_blocks_per_row;
uniform int u_first_slot;
#if GROUND
uniform samplerBuffer u_skies;
#endif

out vec4 out_result;

void main()
{
    out_result = vec4(0.0);
    int slot = index_of_texel(ivec2(gl_FragCoord.xy)) - u_first_slot;
    if (slot >= u_slot_count)
        return;
    ivec2 pixel = pixel_of_slot(slot, u_blocks_per_row);
    vec4  share = texelFetch(u_share, pixel, 0);
    vec3  shares = share.yzw / share.x;
#if GROUND
    shares = share.x > 0.0 ? shares : vec3(1.0);
#endif
    float openness = shares.x;
    vec4  bare     = texelFetch(u_bent, pixel, 0);
    out_result.xyz = bare.xyz;

    float fill = clamp((1.0 - openness - u_fill_from) / kMaskFillRange, 0.0, 1.0);
    if (openness > 0.0 && bare.w > 0.0)
        openness -= (1.0 - fill) * bare.w / share.x;
    if (fill > 0.0 && shares.x > 0.0) {
        vec4  filled     = texelFetch(u_bent_filled, pixel, 0);
        vec4  closed     = texelFetch(u_bent_closed, pixel, 0);
        float fill_share = fill * kMaskFillShare;
        openness -= fill_share * (shares.x - shares.y);
        out_result.xyz = filled.xyz;
        float narrow = (1.0 - openness - kMaskNarrowFrom) / kMaskNarrowRange;
        if (narrow > 0.0 && openness > 0.0)
            openness -= min(narrow, 1.0) * fill_share * (shares.y - filled.w / share.x);
        float close = (1.0 - openness - kMaskCloseFrom) / kMaskCloseRange;
        if (u_close > 0.0 && close > 0.0 && openness > 0.0) {
            openness += min(close, 1.0) * u_close * min(shares.z - openness, 0.0);
            out_result.xyz = closed.xyz;
        }
    }
    openness = clamp(openness, 0.0, 1.0);
#if GROUND
    openness *= texelFetch(u_skies, slot).x;
#endif
    out_result.w = 1.0 - openness;
    out_result *= u_weight;
}
