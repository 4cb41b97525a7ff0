#version 330 core
#include "bent_normal.glsl"
#include "rows.glsl"
// masks_answer.frag: occlusion and bent normal of each receiver, in the receivers' order and frame.
//
// Vertices   fullscreen.vert, over rows of receivers (rows.glsl)
// Drawn by   gpu/gpu_masks.cpp, last
// Reads      u_sums       out_result of masks_result.frag, summed over the distance limits, in rows of slots
//            u_receivers  RGBA32UI: normal.xyz as bits | slot; 0xFFFFFFFF: it has no normal
//            u_turn_back  from the mask frame to the receivers'
// Writes     out_answer   RGBA32F: bent normal | occlusion (surfels/occlusion.h)
// CPU twin   solve in tree/masks/kernel_body.h
uniform sampler2D u_sums;
uniform usamplerBuffer u_receivers;
uniform mat3 u_turn_back;

out vec4 out_answer;

void main()
{
    out_answer     = vec4(0.0);
    uvec4 receiver = texelFetch(u_receivers, index_of_texel(ivec2(gl_FragCoord.xy)));
    if (receiver.w == 0xFFFFFFFFu)
        return;
    vec4 sum   = texelFetch(u_sums, texel_of_index(int(receiver.w)), 0);
    out_answer = vec4(bent_normal_of(u_turn_back * sum.xyz, uintBitsToFloat(receiver.xyz)),
                      sum.w);
}
