#version 330 core
#include "mask_raster.glsl"
#include "receiver_grid.glsl"
// masks_face.frag: what one face of each mask is worth, added to the other faces by blending.
//
// Vertices   fullscreen.vert
// Drawn by   gpu/gpu_masks.cpp, after masks_walk.frag
// Reads      u_words0, u_words1, u_words2, u_words3  the mask's rows (masks_walk.frag)
//            u_first           RGBA32UI holding ints: MaskRaster::sum1 of tree/mask_raster.h
//            u_second          the same: MaskRaster::sum2, 2 texels an entry
//            u_receivers       RGBA32F, 2 texels a slot, mask frame: position.xyz 0 | normal.xyz 0
//            u_slot_count, u_blocks_per_row  (receiver_grid.glsl)
//            u_face            from the mask frame to the face's axes
// Writes     out_share         RGBA32F: integral of n.w over the hemisphere, over the open bits, 0 0
//            out_bent          integral of w (n.w) over the open bits, mask frame, 0
// CPU twin   sum_bits, horizon, solve in tree/mask_kernel_body.h
uniform usampler2D u_words0;
uniform usampler2D u_words1;
uniform usampler2D u_words2;
uniform usampler2D u_words3;
uniform usamplerBuffer u_first;
uniform usamplerBuffer u_second;
uniform samplerBuffer u_receivers;
uniform int u_slot_count;
uniform int u_blocks_per_row;
uniform mat3 u_face;

layout(location = 0) out vec4 out_share;
layout(location = 1) out vec4 out_bent;

// Times w (n.w), from the products of the coordinates in the face's axes.
vec3 bent_of(uint entry, vec3 n)
{
    vec4 a = vec4(ivec4(texelFetch(u_second, int(entry) * 2)));      // xx xy xz yy
    vec4 b = vec4(ivec4(texelFetch(u_second, int(entry) * 2 + 1)));  // yz zz
    return vec3(dot(a.xyz, n), dot(vec3(a.y, a.w, b.x), n), dot(vec3(a.z, b.x, b.y), n));
}

void main()
{
    out_share = out_bent = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int   slot  = slot_at_pixel(pixel, u_blocks_per_row);
    if (slot >= u_slot_count)
        return;
    vec3 n = u_face * texelFetch(u_receivers, slot * 2 + 1).xyz;
    Rows above = all_bits();
    cut(above, n);
    uvec4 words[4] = uvec4[4](texelFetch(u_words0, pixel, 0), texelFetch(u_words1, pixel, 0),
                              texelFetch(u_words2, pixel, 0), texelFetch(u_words3, pixel, 0));

    for (int y = 0; y < 16; ++y) {
        uint hemisphere = above.words[y >> 2][y & 3];
        uint open_row   = hemisphere & ~words[y >> 2][y & 3];
        for (int k = 0; k < 8; ++k) {
            uint base  = uint(y * 8 + k) * 16u;
            uint whole = base + ((hemisphere >> (4 * k)) & 15u);
            uint open  = base + ((open_row >> (4 * k)) & 15u);
            out_share.x += dot(vec3(ivec3(texelFetch(u_first, int(whole)).xyz)), n);
            out_share.y += dot(vec3(ivec3(texelFetch(u_first, int(open)).xyz)), n);
            out_bent.xyz += bent_of(open, n);
        }
    }
    out_bent.xyz = out_bent.xyz * u_face;
}
