#version 330 core
#include "receiver_grid.glsl"
#include "rows.glsl"
// masks_result.frag: occlusion and bent normal of each slot from the sums over all faces.
//
// Vertices   fullscreen.vert, over rows of slots (rows.glsl)
// Drawn by   gpu/gpu_masks.cpp
// Reads      u_share, u_bent   outputs of masks_face.frag, summed over the faces
//            u_slot_count, u_blocks_per_row  (receiver_grid.glsl)
// Writes     out_result      RGBA32F: bent normal, mask frame, any length, zero where all is closed |
//                            occlusion (surfels/occlusion.h)
// CPU twin   solve in tree/mask_kernel_body.h
uniform sampler2D u_share;
uniform sampler2D u_bent;
uniform int u_slot_count;
uniform int u_blocks_per_row;

out vec4 out_result;

void main()
{
    out_result = vec4(0.0);
    int slot = index_of_texel(ivec2(gl_FragCoord.xy));
    if (slot >= u_slot_count)
        return;
    ivec2 pixel = pixel_of_slot(slot, u_blocks_per_row);
    vec3  share = texelFetch(u_share, pixel, 0).xyz;
    out_result.xyz = texelFetch(u_bent, pixel, 0).xyz;
    out_result.w   = 1.0 - clamp(share.y / share.x, 0.0, 1.0);
}
