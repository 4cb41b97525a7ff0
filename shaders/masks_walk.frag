#version 330 core
#include "mask_raster.glsl"
#include "receiver_grid.glsl"
// masks_walk.frag: one fragment is half a face of one receiver's mask; it walks the tree and draws what
// stands before that half. Takes a bounded number of steps, for the next draw to go on.
//
// Vertices   fullscreen.vert
// Drawn by   gpu/gpu_masks.cpp, in pieces, once per half face
// Reads      u_nodes           RGBA32UI, 4 texels a node: MaskNode of tree/masks/tree.h in preorder,
//                              the last word flags of tree/masks/constants.inc and the node after
//                              its subtree
//            u_node_count
//            u_receivers       RGBA32F, 2 texels a slot, mask frame: position.xyz 0 | normal.xyz 0
//            u_slot_count, u_blocks_per_row  (receiver_grid.glsl)
//            u_face            from the mask frame to the face's axes
//            u_half            0: rows 0 to 7, where V < 0; 1: rows 8 to 15
//            u_groups          RGBA32F, 3 texels a group of 16 slots (disks_gather.frag)
//            u_cluster, u_cluster_limit, u_crossing, u_share, u_graze, u_one_sided, u_max_distance  MaskSettings of
//                              tree/masks/kernel.h; u_share is share_leaf; no limit: the largest float
//            u_exact_radius    nodes with no larger open_radius are drawn as they are; -1: leaves alone
//            u_words0, u_words1, u_sheets0, u_sheets1, u_at  the outputs of the draw before
//            u_continued       0: there was none
//            u_step_limit      nodes looked at in one draw; each may go round two loops
// Writes     out_words0, 1     RGBA32UI: the mask's rows
//            out_sheets0, 1     the same: what of it sheets have set
//            out_at            R32UI: node to go on with; u_node_count or more: done
// CPU twin   walk<true>, draw_near and draw in tree/masks/kernel_walk.h, _solve.h and _raster.h: the same
//            decisions for groups of 16, but
//            the CPU's larger groups share what is far: tests/gpu/gpu_masks_test.cpp says how much
//            that makes
uniform usamplerBuffer u_nodes;
uniform int u_node_count;
uniform samplerBuffer u_receivers;
uniform int u_slot_count;
uniform int u_blocks_per_row;
uniform mat3 u_face;
uniform int u_half;
uniform samplerBuffer u_groups;
uniform float u_cluster;
uniform float u_share;
uniform float u_cluster_limit;
uniform float u_crossing;
uniform float u_graze;
uniform int u_one_sided;
uniform float u_max_distance;
uniform float u_exact_radius;
uniform usampler2D u_words0;
uniform usampler2D u_words1;
uniform usampler2D u_sheets0;
uniform usampler2D u_sheets1;
uniform usampler2D u_at;
uniform int u_continued;
uniform int u_step_limit;

layout(location = 0) out uvec4 out_words0;
layout(location = 1) out uvec4 out_words1;
layout(location = 2) out uvec4 out_sheets0;
layout(location = 3) out uvec4 out_sheets1;
layout(location = 4) out uint out_at;

// Negative where the point lies beyond one of the four planes that bound the half face.
vec4 within_half(vec3 p)
{
    float v = u_half == 0 ? -p.z : p.z;
    return vec4(p.x - p.y, p.x + p.y, p.x - v, v);
}

// Of a node, unit; zero where there is no area.
vec3 normal_of(vec3 axis_a, vec3 axis_b)
{
    vec3 n = cross(axis_a, axis_b);
    return n * inversesqrt(max(dot(n, n), kMaskTiny));
}

// long: one walk, whose state are locals that functions would have to hand to and fro
void main()
{
    out_words0 = out_words1 = out_sheets0 = out_sheets1 = uvec4(0u);
    out_at     = 0xFFFFFFFFu;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int   slot  = slot_at_pixel(pixel, u_blocks_per_row);
    if (slot >= u_slot_count)
        return;
    vec3 position = texelFetch(u_receivers, slot * 2).xyz;
    vec3 up       = u_face * texelFetch(u_receivers, slot * 2 + 1).xyz;
    // no corner of the half face is above the horizon: nothing of it counts
    if (up.x + abs(up.y) + max(u_half == 0 ? -up.z : up.z, 0.0) <= 0.0)
        return;

    vec4  group    = texelFetch(u_groups, slot / 16 * 3);
    vec4  cone     = texelFetch(u_groups, slot / 16 * 3 + 1);
    vec2  rest     = texelFetch(u_groups, slot / 16 * 3 + 2).xy;
    float cone_sin = rest.x;
    float sag      = min(rest.y, kMaskLargestSag);

    uvec4 words0 = uvec4(0u);
    uvec4 words1 = uvec4(0u);
    uvec4 sheets0 = uvec4(0u);
    uvec4 sheets1 = uvec4(0u);
    int   at     = 0;
    if (u_continued != 0) {
        words0 = texelFetch(u_words0, pixel, 0);
        words1 = texelFetch(u_words1, pixel, 0);
        sheets0 = texelFetch(u_sheets0, pixel, 0);
        sheets1 = texelFetch(u_sheets1, pixel, 0);
        at     = int(texelFetch(u_at, pixel, 0).x);
    }
    int q     = 2 * u_half;  // the half's first quarter
    int steps = 0;
    while (at < u_node_count && steps < u_step_limit) {
        // the short loop: to the next node that is drawn. What is used behind the loop is fetched
        // there again: llvmpipe goes on computing for receivers that have left a loop as long as
        // their neighbours are in it, so a value from inside may be of a later round
        bool found  = false;
        bool shared = false;
        do {
            ++steps;
            vec4  ball  = uintBitsToFloat(texelFetch(u_nodes, at * 4));
            float thickness = uintBitsToFloat(texelFetch(u_nodes, at * 4 + 1).w);
            vec4  axis_a    = uintBitsToFloat(texelFetch(u_nodes, at * 4 + 2));
            uvec4 axis_b    = texelFetch(u_nodes, at * 4 + 3);
            float open_radius = axis_a.w;
            // how high above any of the group's horizons it may reach, and so how much it may weigh
            vec3  to_node   = ball.xyz - group.xyz;
            float distance2 = max(dot(to_node, to_node), kMaskTiny);
            float inverse   = inversesqrt(distance2);
            float distance  = distance2 * inverse;
            float height    = dot(to_node, cone.xyz);
            float aside     = sqrt(max(distance2 - height * height, 0.0));
            float base      = height < cone.w * distance ? height * cone.w + aside * cone_sin
                                                         : distance;
            float facing    = dot(normal_of(axis_a.xyz, uintBitsToFloat(axis_b.xyz)), cone.xyz);
            float tilt      = sqrt(max(1.0 - facing * facing, 0.0)) + cone_sin;
            float top       = base + min(ball.w, ball.w * tilt + thickness) + sag;
            float nearest   = distance - ball.w;
            vec4  within    = within_half(u_face * (ball.xyz - position));
            bool  before    = all(greaterThan(within, vec4(-kMaskFaceReach * ball.w)));
            bool  alive     = before && top > max(u_graze * (nearest - group.w), 0.0) &&
                         nearest - group.w < u_max_distance;
            float relax     = inversesqrt(clamp(top * inverse, kMaskImportanceFloor, 1.0));
            float cluster   = min(u_cluster * relax, u_cluster_limit);
            if (distance + ball.w + group.w > u_max_distance)
                cluster *= u_crossing;
            shared = group.w < u_share * relax * nearest;
            float from_all = shared ? distance : distance - group.w;
            found = alive && (open_radius <= u_exact_radius || open_radius < cluster * from_all);
            if (!alive)
                at = int(axis_b.w & kMaskFirstChild);
            else if (!found)
                ++at;
        } while (!found && at < u_node_count && steps < u_step_limit);
        if (!found || at >= u_node_count)
            break;

        uvec4 third    = texelFetch(u_nodes, at * 4 + 2);
        uvec4 last     = texelFetch(u_nodes, at * 4 + 3);
        bool  triangle = (last.w & kMaskTriangle) != 0u;
        bool  exact    = uintBitsToFloat(third.w) <= u_exact_radius;
        vec4  ball     = uintBitsToFloat(texelFetch(u_nodes, at * 4));
        vec3  center   = u_face * (ball.xyz - position);
        float radius   = ball.w;
        // which side is seen: shared polygons from the group's centre
        vec3  axis_a   = uintBitsToFloat(third.xyz);
        vec3  axis_b   = uintBitsToFloat(last.xyz);
        vec3  normal   = normal_of(axis_a, axis_b);
        vec3  to_node  = ball.xyz - group.xyz;
        float away     = dot(normal, to_node);
        float own_away = shared ? away : dot(normal, ball.xyz - position);
        bool  dropped = u_one_sided != 0 && (last.w & kMaskSolid) != 0u && own_away < 0.0;
        // cracks are beside what is wide enough for them
        float narrow = min(kMaskNarrowSheet, kMaskNarrowCluster * u_cluster);
        vec3  side   = axis_a + axis_b;
        bool  sheet  = !exact && (last.w & kMaskSheet) != 0u &&
                      narrow * narrow * dot(to_node, to_node) < dot(side, side);
        float grow    = sheet && (last.w & kMaskHollow) != 0u && away < 0.0 ? kMaskHollowGrowth : 1.0;
        vec3  skew = u_face * uintBitsToFloat(texelFetch(u_nodes, at * 4 + 1).xyz);
        axis_a     = u_face * axis_a;
        axis_b     = u_face * axis_b;
        // how high the highest corner is, and how high it must be as far away as the centre
        float odd = dot(axis_b, up);
        float top = dot(center, up) + max(dot(skew, up) + abs(dot(axis_a, up)),
                                          (triangle ? odd : abs(odd)) - dot(skew, up));
        float least = u_graze * u_graze * (dot(center, center) - radius * radius);
        axis_a *= grow;
        axis_b *= grow;
        at = int(last.w & kMaskFirstChild);

        // planes through the receiver and each edge, turned inward; a triangle's first counts twice
        vec3 c0 = center + skew + axis_a;
        vec3 c1 = center - skew + axis_b;
        vec3 c2 = center + skew - axis_a;
        vec3 c3 = triangle ? c0 : center - skew - axis_b;
        vec3 n0 = cross(c0, c1 - c0);
        vec3 n3 = triangle ? n0 : cross(c3, c0 - c3);
        float volume = dot(n0, c2 - c1);
        float turn   = volume < 0.0 ? -1.0 : 1.0;
        Side  side0  = side_of(turn * n0);
        Side  side1  = side_of(turn * cross(c1, c2 - c1));
        Side  side2  = side_of(turn * cross(c2, c3 - c2));
        Side  side3  = side_of(turn * n3);
        uvec4 inside0 = bits_of(side0, q) & bits_of(side1, q) & bits_of(side2, q) & bits_of(side3, q);
        uvec4 inside1 = bits_of(side0, q + 1) & bits_of(side1, q + 1) & bits_of(side2, q + 1) &
                        bits_of(side3, q + 1);

        // planes beyond the limit are dropped, polygons that cross it cut to a cone
        normal = cross(c1 - c0, c2 - c0);
        normal *= inversesqrt(max(dot(normal, normal), kMaskTiny));
        float height = dot(normal, c0);
        if (height < 0.0) {
            normal = -normal;
            height = -height;
        }
        vec4  squares   = vec4(dot(c0, c0), dot(c1, c1), dot(c2, c2), dot(c3, c3));
        float farthest2 = max(max(squares.x, squares.y), max(squares.z, squares.w));
        if (farthest2 > u_max_distance * u_max_distance) {
            inside0 &= cone_bits(normal, height / u_max_distance, q);
            inside1 &= cone_bits(normal, height / u_max_distance, q + 1);
        }

        // not where it lies wholly below the horizon, or so little above that it weighs nothing.
        // Nor beside the half: seen edge-on, its planes are rounding noise
        // and may enclose directions anywhere
        vec4 beside = max(max(within_half(c0), within_half(c1)),
                          max(within_half(c2), within_half(c3)));
        bool seen = !dropped && volume != 0.0 && top > 0.0 && (shared || top * top > least) &&
                    all(greaterThanEqual(beside, vec4(0.0))) && height < u_max_distance;
        uvec4 drawn       = uvec4(seen ? 0xFFFFFFFFu : 0u);
        uvec4 drawn_sheet = uvec4(seen && sheet ? 0xFFFFFFFFu : 0u);
        words0 |= inside0 & drawn;
        words1 |= inside1 & drawn;
        sheets0 |= inside0 & drawn_sheet;
        sheets1 |= inside1 & drawn_sheet;
    }
    out_words0 = words0;
    out_words1 = words1;
    out_sheets0 = sheets0;
    out_sheets1 = sheets1;
    out_at     = uint(at);
}
