#version 330 core
#include "mask_raster.glsl"
#include "receiver_grid.glsl"
// masks_face.frag: what one face of each mask is worth: as drawn, with cracks of one bit filled, and
// with those of two bits closed too; added to the other faces by blending.
//
// Vertices   fullscreen.vert
// Drawn by   gpu/gpu_masks.cpp, after masks_walk.frag
// Definitions  GROUND: 0 or 1. There is a ground: it takes what it covers out of the hemisphere
// Reads      u_low_words0, u_low_words1, u_low_sheets0, u_low_sheets1
//                              outputs of masks_walk.frag for half 0: rows, and what sheets have set
//            u_high_words0, u_high_words1, u_high_sheets0, u_high_sheets1
//                              the same for half 1
//            u_fill            0: as drawn is all there is
//            u_moments         RGBA32F, 3 texels a nibble, row by row: what a set bit of it is worth
//                              (MaskRaster of tree/masks/raster.h). First moments 1 u v of the lower
//                              two bits, second moment 1 | first of the upper two, second u |
//                              second v uu uv vv
//            u_receivers       RGBA32F, 2 texels a slot, mask frame: position.xyz 0 | normal.xyz 0
//            u_slot_count, u_blocks_per_row  (receiver_grid.glsl)
//            u_face            from the mask frame to the face's axes
//            u_skies           RG32F, one a slot: sky's share | signed height over the ground (GROUND)
//            u_up              the ground's, in the face's axes                               (GROUND)
//            u_max_distance    no limit: the largest float                                    (GROUND)
// Writes     out_share         RGBA32F: integral of n.w over the hemisphere, over the open bits, over
//                              those left open by filling, over those left open by closing
//            out_bent, out_bent_filled, out_bent_closed
//                              RGBA32F: integral of w (n.w) over the same bits, of the first without
//                              pinholes, mask frame | integral of n.w over pinholes | over what filling
//                              beside narrow clusters too leaves open | 0
// CPU twin   first_moments and second_moments in tree/masks/kernel_sums.h, horizon and take_ground in
//            _raster.h, pinholes, fill, openings and close in _cracks.h
#ifndef GROUND
#define GROUND 0
#endif

uniform usampler2D u_low_words0;
uniform usampler2D u_low_words1;
uniform usampler2D u_low_sheets0;
uniform usampler2D u_low_sheets1;
uniform usampler2D u_high_words0;
uniform usampler2D u_high_words1;
uniform usampler2D u_high_sheets0;
uniform usampler2D u_high_sheets1;
uniform int u_fill;
uniform samplerBuffer u_moments;
uniform samplerBuffer u_receivers;
uniform int u_slot_count;
uniform int u_blocks_per_row;
uniform mat3 u_face;
#if GROUND
uniform samplerBuffer u_skies;
uniform vec3 u_up;
uniform float u_max_distance;
#endif

layout(location = 0) out vec4 out_share;
layout(location = 1) out vec4 out_bent;
layout(location = 2) out vec4 out_bent_filled;
layout(location = 3) out vec4 out_bent_closed;

// Sums over the bits of a face. Integers below 2^24: they do not depend on the order.
struct Sums {
    vec3 first;
    vec4 second;  // xx xy xz yy
    vec2 rest;    // yz zz
};

const Sums kNothing = Sums(vec3(0.0), vec4(0.0), vec2(0.0));

void add(inout Sums sums, int y, uint bits)
{
    uint pairs = bits - ((bits >> 1) & 0x55555555u);  // their set bits
    for (int k = 0; pairs != 0u; ++k, pairs >>= 4) {
        int   entry = (y * 8 + k) * 3;
        float low   = float(pairs & 3u);
        float high  = float((pairs >> 2) & 3u);
        vec4  a     = texelFetch(u_moments, entry);
        vec4  b     = texelFetch(u_moments, entry + 1);
        vec4  c     = texelFetch(u_moments, entry + 2);
        sums.first += low * a.xyz + high * b.xyz;
        sums.second += (low + high) * vec4(a.w, b.w, c.xy);
        sums.rest += (low + high) * c.zw;
    }
}

float along(Sums sums, vec3 n) { return dot(sums.first, n); }

vec4 bent(Sums sums, vec3 n, float share)
{
    vec4 a = sums.second;
    vec2 b = sums.rest;
    vec3 turned = vec3(dot(a.xyz, n), dot(vec3(a.y, a.w, b.x), n), dot(vec3(a.z, b.x, b.y), n));
    return vec4(turned * u_face, share);
}

float shift_of(int y) { return kRowShift[y >> 2][y & 3]; }

// The bits of a neighbouring row that are not right beside those of row y but next to it.
uint beside(uint row, int neighbour, int y)
{
    return shift_of(clamp(neighbour, 0, 15)) > shift_of(y) ? row << 1 : row >> 1;
}

// Row y of a face, grown by one bit across the rows.
uint grown_across(uint rows[18], int y)
{
    uint low  = rows[y];
    uint high = rows[y + 2];
    return rows[y + 1] | low | beside(low, y - 1, y) | high | beside(high, y + 1, y);
}

// Of the neighbours of row y's bits those left and right, and those below and above, of which each
// is the two nearest in direction. rows: as in main.
uint all_sides(uint rows[18], int y) { return (rows[1 + y] << 1) & (rows[1 + y] >> 1); }
uint any_sides(uint rows[18], int y) { return (rows[1 + y] << 1) | (rows[1 + y] >> 1); }
uint all_stacked(uint rows[18], int y)
{
    uint low  = rows[y];
    uint high = rows[2 + y];
    return low & beside(low, y - 1, y) & high & beside(high, y + 1, y);
}
uint any_stacked(uint rows[18], int y)
{
    uint low  = rows[y];
    uint high = rows[2 + y];
    return low | beside(low, y - 1, y) | high | beside(high, y + 1, y);
}

// What filling leaves open in row y and what touches it: a notch in the rim of an opening is most
// likely part of it.
uint rim_of(uint filled[18], int y)
{
    uint left = ~filled[1 + y];
    return left | (left << 1) | (left >> 1) | (y > 0 ? ~filled[y] : 0u) |
           (y < 15 ? ~filled[2 + y] : 0u);
}

#if GROUND
// The bits of quarter q that the ground covers, seen from a signed height over it.
uvec4 ground_bits(float height, int q)
{
    vec3  towards = height < 0.0 ? u_up : -u_up;
    float edge    = abs(height) / u_max_distance;
    if (edge >= 1.0)
        return uvec4(0u);
    return edge < kMaskConeFlat ? bits_of(side_of(towards), q) : cone_bits(towards, edge, q);
}
#endif

// long: one row after the other, with the same dozen sums at hand
void main()
{
    out_share = out_bent = out_bent_filled = out_bent_closed = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int   slot  = slot_at_pixel(pixel, u_blocks_per_row);
    if (slot >= u_slot_count)
        return;
    vec3  n = u_face * texelFetch(u_receivers, slot * 2 + 1).xyz;
    uvec4 drawn[4] = uvec4[4](texelFetch(u_low_words0, pixel, 0), texelFetch(u_low_words1, pixel, 0),
                              texelFetch(u_high_words0, pixel, 0),
                              texelFetch(u_high_words1, pixel, 0));
    uvec4 of_sheets[4] = uvec4[4](
        texelFetch(u_low_sheets0, pixel, 0), texelFetch(u_low_sheets1, pixel, 0),
        texelFetch(u_high_sheets0, pixel, 0), texelFetch(u_high_sheets1, pixel, 0));

    // rows with an empty one before the first and behind the last; what lies below the horizon is no
    // opening
    uint closed[18], sheets[18], above[18];
    closed[0] = sheets[0] = closed[17] = sheets[17] = above[0] = above[17] = 0u;
    Side horizon = side_of(n);
    for (int q = 0; q < 4; ++q) {
        uvec4 hemisphere = bits_of(horizon, q);
#if GROUND
        hemisphere &= ~ground_bits(texelFetch(u_skies, slot).y, q);
#endif
        for (int i = 0; i < 4; ++i) {
            above[1 + 4 * q + i]  = hemisphere[i];
            closed[1 + 4 * q + i] = drawn[q][i] | ~hemisphere[i];
            sheets[1 + 4 * q + i] = of_sheets[q][i];
        }
    }
    Sums whole = kNothing;
    Sums open  = kNothing;  // of these two, only `first` is of use
    Sums rest  = kNothing;  // without pinholes
    for (int y = 0; y < 16; ++y) {
        uint pinholes = u_fill == 0 ? 0u
                                    : all_sides(closed, y) & all_stacked(closed, y) &
                                          (any_sides(sheets, y) | any_stacked(sheets, y));
        add(whole, y, above[1 + y]);
        add(open, y, ~closed[1 + y]);
        add(rest, y, ~closed[1 + y] & ~pinholes);
    }
    out_share = vec4(along(whole, n), vec3(along(open, n)));
    out_bent  = bent(rest, n, along(open, n) - along(rest, n));
    if (u_fill == 0)
        return;

    // cracks of one bit: neighbours on both sides are set, and a sheet has set one of them
    uint filled[18], all_filled[18];  // the second: whoever has set them
    filled[0] = filled[17] = all_filled[0] = all_filled[17] = 0u;
    for (int y = 0; y < 16; ++y) {
        uint m       = closed[1 + y];
        uint sides   = all_sides(closed, y);
        uint stacked = all_stacked(closed, y);
        filled[1 + y] =
            m | (sides & any_sides(sheets, y)) | (stacked & any_stacked(sheets, y));
        all_filled[1 + y] = m | sides | stacked;
    }
    // cracks of two bits: grown by one bit along the rows, then across them, and shrunk again, where
    // a sheet has set a bit nearby
    uint grown[18], wide_sheets[18];
    grown[0] = grown[17] = wide_sheets[0] = wide_sheets[17] = 0u;
    for (int y = 0; y < 16; ++y) {
        grown[1 + y]       = grown_across(filled, y);
        wide_sheets[1 + y] = sheets[1 + y] | any_sides(sheets, y);
    }
    // what is left open by filling, by filling beside all, by closing
    Sums openings = kNothing, left = kNothing, unclosed = kNothing;
    for (int y = 0; y < 16; ++y) {
        uint m        = filled[1 + y];
        uint wide     = m | (m << 1) | (m >> 1);
        uint rows     = wide & (wide << 1) & (wide >> 1);
        uint columns  = grown[1 + y] & all_stacked(grown, y);
        add(openings, y, ~closed[1 + y] & rim_of(filled, y));
        add(left, y, ~closed[1 + y] & rim_of(all_filled, y));
        add(unclosed, y, ~(m | ((rows | columns) & grown_across(wide_sheets, y))));
    }
    out_share.zw    = vec2(along(openings, n), along(unclosed, n));
    out_bent_filled = bent(openings, n, along(left, n));
    out_bent_closed = bent(unclosed, n, 0.0);
}
