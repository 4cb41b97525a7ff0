#version 330 core
#include "disk_record.glsl"
#include "receiver_grid.glsl"
#include "rows.glsl"
#include "triangle_moment.glsl"
// disks_gather.frag: one fragment is one receiver; it walks the octree and sums what each disk covers.
//
// A draw takes a bounded number of steps and leaves off where it stands, for the next draw to go on:
// no single draw is long, whatever the scene, and llvmpipe ends every loop, without a word, once a
// shader has gone round 65,535 times.
//
// Vertices     fullscreen.vert
// Drawn by     gpu/gpu_disks.cpp, in pieces (gpu/receiver_grid.h)
// Definitions  TWO_SIDED LIMITED BUNNELL GROUND: 0 or 1. Some surfels occlude from both sides;
//              max_distance is finite; Kernel::bunnell; there is a ground
// Reads        u_records         octree, 3 texels a record (disk_record.glsl)
//              u_record_count
//              u_corners         RGBA32F, 2 texels a triangle: from the centroid to two corners
//              u_triangles       0: near triangles too are summed as disks (BUNNELL: always 0)
//              u_two_sided_from  records from here on occlude from both sides   (TWO_SIDED)
//              u_far_front       per record, in rows: FarVisibility of tree/disks/form_factor.h on the
//                                side that the casting normal points to: slope.xyz constant
//              u_far_back        the same for the other side                    (TWO_SIDED)
//              u_receivers       RGBA32F, 2 texels a slot: position.xyz 0 | normal.xyz 0
//              u_groups          RGBA32F, 3 texels a group of 16 slots (tree/receiver_groups.h):
//                                center.xyz radius | axis.xyz cone_cos | cone_sin rise 0 0
//              u_slot_count, u_blocks_per_row  (receiver_grid.glsl)
//              u_sums, u_at      out_sum and out_at of the draw before
//              u_continued       0: there was none
//              u_step_limit      records looked at in one draw; each may go round two loops
//              u_opening         as DiskOptions::opening
//              u_max_distance    in diagonals                                   (LIMITED)
//              u_smooth          1: Falloff::smooth, 0: none                    (LIMITED)
//              u_ground          RGBA32F, one a slot: what the ground covers, as out_sum (GROUND)
//              u_up, u_ground_height  Ground of surfels/occlusion.h             (GROUND)
// Writes       out_sum           RGBA32F: sum of form factors times direction | sum of form factors
//              out_at            R32UI: record to go on with; u_record_count or more: done
// CPU twin     tree/disks/gather.cpp; formulas: tree/disks/form_factor.h;
//              tests/gpu/gpu_disks_test.cpp holds them together
#ifndef TWO_SIDED
#define TWO_SIDED 0
#endif
#ifndef LIMITED
#define LIMITED 0
#endif
#ifndef BUNNELL
#define BUNNELL 0
#endif
#ifndef GROUND
#define GROUND 0
#endif

uniform usamplerBuffer u_records;
uniform int u_record_count;
uniform samplerBuffer u_corners;
uniform int u_triangles;
uniform sampler2D u_far_front;
uniform samplerBuffer u_receivers;
uniform samplerBuffer u_groups;
uniform int u_slot_count;
uniform int u_blocks_per_row;
uniform sampler2D u_sums;
uniform usampler2D u_at;
uniform int u_continued;
uniform int u_step_limit;
uniform float u_opening;
#if TWO_SIDED
uniform int u_two_sided_from;
uniform sampler2D u_far_back;
#endif
#if LIMITED
uniform float u_max_distance;
uniform int u_smooth;
#endif
#if GROUND
uniform samplerBuffer u_ground;
uniform vec3 u_up;
uniform float u_ground_height;
#endif

layout(location = 0) out vec4 out_sum;
layout(location = 1) out uint out_at;

const float kPi         = 3.14159265358979;
const float kTinyLength = 1e-8;
const float kLimitPenalty = 4.0;
const float kNearDisk   = 1.0 / 9.0;

// long: one walk, whose state are locals that functions would have to hand to and fro
void main()
{
    out_sum = vec4(0.0);
    out_at  = 0xFFFFFFFFu;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int   slot  = slot_at_pixel(pixel, u_blocks_per_row);
    if (slot >= u_slot_count)
        return;
    vec3  position = texelFetch(u_receivers, slot * 2).xyz;
    vec3  normal   = texelFetch(u_receivers, slot * 2 + 1).xyz;
    vec4  group    = texelFetch(u_groups, slot / 16 * 3);
    vec4  cone     = texelFetch(u_groups, slot / 16 * 3 + 1);
    vec2  rest     = texelFetch(u_groups, slot / 16 * 3 + 2).xy;
    float cone_sin = rest.x;
    float rise     = rest.y;

    vec4 sum = u_continued != 0 ? texelFetch(u_sums, pixel, 0) : vec4(0.0);
#if GROUND
    if (u_continued == 0)
        sum = texelFetch(u_ground, slot);
    float over    = dot(u_up, position) - u_ground_height;
    vec3  towards = over < 0.0 ? u_up : -u_up;
#endif
    int  at  = u_continued != 0 ? int(texelFetch(u_at, pixel, 0).x) : 0;
    int  steps = 0;
    while (at < u_record_count && steps < u_step_limit) {
        // the short loop: to the next record that counts as one disk. All receivers of a group take
        // the same way, and open for the nearest place where one of them could be
        vec4 ball;
        bool found = false;
        do {
            ++steps;
            ball           = fetch_ball(u_records, at);
            vec3  offset    = ball.xyz - group.xyz;
            float distance2 = dot(offset, offset);
            float distance  = sqrt(distance2) - group.w;
            // wholly below every receiver's horizon (rise_of_cone), or out of reach
            float along   = dot(offset, cone.xyz);
            float top     = along * cone.w + rise + (ball.w < 0.0 ? -1.0 - ball.w : ball.w);
            float across2 = (distance2 - along * along) * cone_sin * cone_sin;
            bool  skip    = top < 0.0 && across2 < top * top;
#if LIMITED
            skip = skip || (ball.w >= 0.0 && distance - ball.w > u_max_distance);
#endif
            float size = ball.w;
#if LIMITED
            size *= distance + 2.0 * group.w + size > u_max_distance ? kLimitPenalty : 1.0;
#endif
            found = !skip && (size < u_opening * distance || ball.w < 0.0);
            if (skip)
                at = int(fetch_links(u_records, at).x);
            else if (!found)
                ++at;
        } while (!found && at < u_record_count && steps < u_step_limit);
        // llvmpipe goes on computing for receivers that have left a loop as long as their neighbours
        // are in it: `at` stays where it is then, and what was computed from it is the same again
        if (!found || at >= u_record_count)
            break;

        ball = fetch_ball(u_records, at);
        vec4  shape     = fetch_normal_and_flat_area(u_records, at);
        uvec4 links     = fetch_links(u_records, at);
        float area      = uintBitsToFloat(links.y);
        vec4  far_front = texelFetch(u_far_front, texel_of_index(at), 0);
        vec3  c         = ball.xyz - position;
        float inverse   = inversesqrt(dot(c, c) + kTinyLength * kTinyLength);
        vec3  w         = c * inverse;
        float inverse2  = inverse * inverse / kPi;
        float at_receiver = max(0.0, dot(normal, w));
        float at_disk     = dot(shape.xyz, w);
        float facing      = max(0.0, at_disk);
        float spread      = 0.25;
#if TWO_SIDED
        if (at >= u_two_sided_from) {
            facing = abs(at_disk);
            spread = 0.5;
        }
#endif
        float x = shape.w * inverse2;
#if BUNNELL
        float form_factor = (1.0 - inversesqrt(1.0 + x)) * facing * min(1.0, 4.0 * at_receiver);
#else
        float all        = area * inverse2;
        float second     = x < kNearDisk ? x : 0.0;
        float correction = at_receiver * (2.0 - 3.0 * at_disk * at_disk) +
                           at_disk * dot(normal, shape.xyz);
        float flat_part   = x * facing * max(0.0, at_receiver + second * correction);
        float spread_part = max(0.0, all - x) * spread * at_receiver;
        float form_factor = at_receiver > 0.0 ? (flat_part + spread_part) / (1.0 + all) : 0.0;
#endif
        if (u_triangles != 0 && ball.w < 0.0 && links.z != 0u && x >= kNearDisk) {
            int  corners = 2 * int(links.z - 1u);
            vec3 moment  = moment_of_triangle(c, texelFetch(u_corners, corners).xyz,
                                              texelFetch(u_corners, corners + 1).xyz, normal);
            float cover  = dot(moment, normal);
            form_factor  = facing > 0.0 ? abs(cover) : 0.0;
            w            = unit_or_zero(cover < 0.0 ? -moment : moment);
        }
        float seen = far_front.w + dot(far_front.xyz, w);
#if TWO_SIDED
        if (at >= u_two_sided_from && at_disk < 0.0) {
            vec4 far_back = texelFetch(u_far_back, texel_of_index(at), 0);
            seen = far_back.w + dot(far_back.xyz, w);
        }
#endif
        form_factor *= clamp(seen, 0.0, 1.0);
        float weight = 1.0;
#if LIMITED
        float distance = 1.0 / inverse;
        float width    = min(2.0 * sqrt(area / kPi), u_max_distance);
        float share    = clamp(0.5 + (u_max_distance - distance) / width, 0.0, 1.0);
        float t        = distance / u_max_distance;
        float fading   = max(0.0, 1.0 - t * t);
        weight       = u_smooth != 0 ? fading * fading : share;
#endif
#if GROUND
        // ground_weight of tree/disks/form_factor.h
        float height  = dot(c, towards);
        float radius  = sqrt(area / kPi);
        float inside  = height;
#if LIMITED
        float edge = abs(over) / u_max_distance;
        inside -= distance * edge;
#endif
        float covered = clamp(0.5 + 0.5 * inside / radius, 0.0, 1.0);
#if LIMITED
        covered *= clamp(distance * distance * (1.0 - edge * edge) / (radius * radius), 0.0, 1.0);
        float hit      = abs(over) * distance / max(height, kTinyLength) / u_max_distance;
        float fading_hit = max(0.0, 1.0 - hit * hit);
        covered *= u_smooth != 0 ? fading_hit * fading_hit : 1.0;
#endif
        weight = max(0.0, weight - covered);
#endif
        form_factor *= weight;
        sum += vec4(w, 1.0) * form_factor;
        at = int(links.x);
    }
    out_sum = sum;
    out_at  = uint(at);
}
