#version 330 core
#include "mask_raster.glsl"
#include "receiver_grid.glsl"
// masks_walk.frag: one fragment is one face of one receiver's mask; it walks the tree and draws what
// stands before that face. Takes a bounded number of steps, for the next draw to go on.
//
// Vertices   fullscreen.vert
// Drawn by   gpu/gpu_masks.cpp, in pieces, once per face
// Reads      u_nodes           RGBA32UI, 4 texels a node: MaskNode of tree/mask_tree.h in preorder,
//                              the last word the node after its subtree; open_radius -0: a triangle
//            u_node_count
//            u_receivers       RGBA32F, 2 texels a slot, mask frame: position.xyz 0 | normal.xyz 0
//            u_slot_count, u_blocks_per_row  (receiver_grid.glsl)
//            u_face            from the mask frame to the face's axes
//            u_groups          RGBA32F, 3 texels a group of 16 slots (disks_gather.frag)
//            u_cluster, u_cluster_limit, u_share  MaskSettings of tree/mask_kernel.h; u_share is
//                              share_leaf
//            u_exact_radius    nodes with no larger open_radius are drawn as they are
//            u_words0, u_words1, u_words2, u_words3, u_at  the outputs of the draw before
//            u_continued       0: there was none
//            u_step_limit      nodes looked at in one draw; each may go round two loops
// Writes     out_words0 .. 3   RGBA32UI: the mask's rows
//            out_at            R32UI: node to go on with; u_node_count or more: done
// CPU twin   walk<true> and draw in tree/mask_kernel_body.h: the same decisions for groups of 16, but
//            the CPU's larger groups share what is far: tests/gpu/gpu_masks_test.cpp says how much
//            that makes
uniform usamplerBuffer u_nodes;
uniform int u_node_count;
uniform samplerBuffer u_receivers;
uniform int u_slot_count;
uniform int u_blocks_per_row;
uniform mat3 u_face;
uniform samplerBuffer u_groups;
uniform float u_cluster;
uniform float u_share;
uniform float u_cluster_limit;
uniform float u_exact_radius;
uniform usampler2D u_words0;
uniform usampler2D u_words1;
uniform usampler2D u_words2;
uniform usampler2D u_words3;
uniform usampler2D u_at;
uniform int u_continued;
uniform int u_step_limit;

layout(location = 0) out uvec4 out_words0;
layout(location = 1) out uvec4 out_words1;
layout(location = 2) out uvec4 out_words2;
layout(location = 3) out uvec4 out_words3;
layout(location = 4) out uint out_at;

const uint  kTriangle        = 0x80000000u;  // open_radius -0
const float kImportanceFloor = 0.1;
const float kFaceReach       = 1.4143;  // a ball's radius to the face's bounding planes, sqrt(2)

// Negative where the point lies beyond one of the four planes that bound the face.
vec4 within_face(vec3 p)
{
    return vec4(p.x - p.y, p.x + p.y, p.x - p.z, p.x + p.z);
}

void main()
{
    out_words0 = out_words1 = out_words2 = out_words3 = uvec4(0u);
    out_at     = 0xFFFFFFFFu;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int   slot  = slot_at_pixel(pixel, u_blocks_per_row);
    if (slot >= u_slot_count)
        return;
    vec3 position = texelFetch(u_receivers, slot * 2).xyz;
    vec3 normal   = texelFetch(u_receivers, slot * 2 + 1).xyz;

    vec4  group    = texelFetch(u_groups, slot / 16 * 3);
    vec4  cone     = texelFetch(u_groups, slot / 16 * 3 + 1);
    vec2  rest     = texelFetch(u_groups, slot / 16 * 3 + 2).xy;
    float cone_sin = rest.x;
    float sag      = min(rest.y, 1e9);

    Rows mask = Rows(uvec4[4](uvec4(0u), uvec4(0u), uvec4(0u), uvec4(0u)));
    int  at   = 0;
    if (u_continued != 0) {
        mask.words[0] = texelFetch(u_words0, pixel, 0);
        mask.words[1] = texelFetch(u_words1, pixel, 0);
        mask.words[2] = texelFetch(u_words2, pixel, 0);
        mask.words[3] = texelFetch(u_words3, pixel, 0);
        at = int(texelFetch(u_at, pixel, 0).x);
    }
    int steps = 0;
    while (at < u_node_count && steps < u_step_limit) {
        // the short loop: to the next node that is drawn. What is used behind the loop is fetched
        // there again: llvmpipe goes on computing for receivers that have left a loop as long as
        // their neighbours are in it, so a value from inside may be of a later round
        bool found = false;
        do {
            ++steps;
            vec4  ball  = uintBitsToFloat(texelFetch(u_nodes, at * 4));
            vec4  plane = uintBitsToFloat(texelFetch(u_nodes, at * 4 + 1));
            uint  opening     = texelFetch(u_nodes, at * 4 + 2).w;
            float open_radius = uintBitsToFloat(opening);
            // how high above any of the group's horizons it may reach, and so how much it may weigh
            vec3  to_node   = ball.xyz - group.xyz;
            float distance2 = max(dot(to_node, to_node), 1e-30);
            float inverse   = inversesqrt(distance2);
            float distance  = distance2 * inverse;
            float height    = dot(to_node, cone.xyz);
            float aside     = sqrt(max(distance2 - height * height, 0.0));
            float base      = height < cone.w * distance ? height * cone.w + aside * cone_sin
                                                         : distance;
            float facing    = dot(plane.xyz, cone.xyz);
            float tilt      = sqrt(max(1.0 - facing * facing, 0.0)) + cone_sin;
            float top       = base + min(ball.w, ball.w * tilt + plane.w) + sag;
            float nearest   = distance - ball.w;
            vec3  side      = u_face * (ball.xyz - position);
            float reach     = -kFaceReach * ball.w;
            bool  before    = side.x - abs(side.y) > reach && side.x - abs(side.z) > reach;
            bool  alive     = before && top > 0.0;
            float relax     = inversesqrt(clamp(top * inverse, kImportanceFloor, 1.0));
            float cluster   = min(u_cluster * relax, u_cluster_limit);
            bool  far       = group.w < u_share * relax * nearest;
            float from_all   = far ? distance : distance - group.w;
            found = alive && (opening == kTriangle || open_radius <= u_exact_radius || open_radius < cluster * from_all);
            if (!alive)
                at = int(texelFetch(u_nodes, at * 4 + 3).w);
            else if (!found)
                ++at;
        } while (!found && at < u_node_count && steps < u_step_limit);
        if (!found || at >= u_node_count)
            break;

        uvec4 third    = texelFetch(u_nodes, at * 4 + 2);
        uvec4 last     = texelFetch(u_nodes, at * 4 + 3);
        bool  triangle = third.w == kTriangle;
        vec3  center   = u_face * (uintBitsToFloat(texelFetch(u_nodes, at * 4).xyz) - position);
        vec3  axis_u   = u_face * uintBitsToFloat(third.xyz);
        vec3  axis_v   = u_face * uintBitsToFloat(last.xyz);
        at = int(last.w);

        // planes through the receiver and each edge, turned inward; a triangle's first counts twice
        vec3 c0 = triangle ? center + axis_u : center + axis_u + axis_v;
        vec3 c1 = triangle ? center + axis_v : center - axis_u + axis_v;
        vec3 c2 = center - axis_u - axis_v;
        vec3 c3 = triangle ? c0 : center + axis_u - axis_v;
        vec3 n0 = cross(c0, c1 - c0);
        vec3 n3 = triangle ? n0 : cross(c3, c0 - c3);
        float volume = dot(n0, c2 - c1);
        float turn   = volume < 0.0 ? -1.0 : 1.0;
        Rows inside = all_bits();
        cut(inside, turn * n0);
        cut(inside, turn * cross(c1, c2 - c1));
        cut(inside, turn * cross(c2, c3 - c2));
        cut(inside, turn * n3);
        // not where it lies wholly below the horizon or beside the face: seen edge-on, its planes are
        // rounding noise and may enclose directions anywhere
        vec4 beside = max(max(within_face(c0), within_face(c1)),
                          max(within_face(c2), within_face(c3)));
        vec3 up   = u_face * normal;
        float top = max(max(dot(c0, up), dot(c1, up)), max(dot(c2, up), dot(c3, up)));
        bool seen = volume != 0.0 && top > 0.0 && all(greaterThanEqual(beside, vec4(0.0)));
        uvec4 drawn = uvec4(seen ? 0xFFFFFFFFu : 0u);
        for (int q = 0; q < 4; ++q)
            mask.words[q] |= inside.words[q] & drawn;
    }
    out_words0 = mask.words[0];
    out_words1 = mask.words[1];
    out_words2 = mask.words[2];
    out_words3 = mask.words[3];
    out_at     = uint(at);
}
