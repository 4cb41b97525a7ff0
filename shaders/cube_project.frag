#version 330 core
#include "g_buffer.glsl"

// cube_project.frag: what cube maps tell of each pixel of a G-buffer.
//
// Vertices   fullscreen.vert
// Drawn by   pixels/cube_projector.cpp, which says what is tested and why
// Reads      g_buffer.glsl
//            u_eye u_right u_up u_forward  View of the G-buffer
//            u_distances  R32F, all texels of all maps: x + size (y + size (face + 6 map))
//            u_values     R32UI, likewise: occlusion | normal.x << 8 | normal.y << 16, bytes
//            u_maps       RGBA32F, two texels per map in use, falling by weight: its centre, its
//                         index; how much more it weighs than the next one, its weight
//            u_map_count  in use
//            u_face_size  texels along the edge of a face
// Writes     out_answer   occlusion | share: 0 = none answers, 1 = needs no help
// CPU twin   tests/pixels/cube_twin.h

uniform vec3 u_eye;
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec3 u_forward;
uniform samplerBuffer u_distances;
uniform usamplerBuffer u_values;
uniform samplerBuffer u_maps;
uniform int u_map_count;
uniform int u_face_size;

out vec2 out_answer;

const float kPlane = 1.0;         // footprints
const float kReach = 3.0;         // footprints over the cosine
const float kSameNormal = 0.8;    // cosine
const float kLeastWeight = 0.02;  // of the bilinear weights
const float kWhole = 0.5;         // weight of a map that needs no help

vec3 in_world(vec3 v) { return v.x * u_right + v.y * u_up + v.z * u_forward; }

vec3 normal_of(uint value)
{
    vec2 p = vec2((value >> 8u) & 255u, (value >> 16u) & 255u) / 127.5 - 1.0;
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec2 sides = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return normalize(vec3(z < 0.0 ? (1.0 - abs(p.yx)) * sides : p, z));
}

// occlusion and bilinear weight of the texels of one map that count; d: from its centre to the
// point
vec2 read_map(int map, vec3 d, vec3 normal, float cosine)
{
    vec3 size = abs(d);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    bool negative = d[axis] < 0.0;
    int across = (axis + (negative ? 1 : 2)) % 3;
    int along = (axis + (negative ? 2 : 1)) % 3;
    vec2 place = (0.5 + 0.5 * vec2(d[across], d[along]) / size[axis]) * float(u_face_size) - 0.5;
    ivec2 low = ivec2(floor(place));
    vec2 share = place - vec2(low);
    int first = (6 * map + 2 * axis + (negative ? 1 : 0)) * u_face_size * u_face_size;
    float footprint = 2.0 * length(d) / float(u_face_size);

    vec2 sum = vec2(0.0);
    for (int k = 0; k < 4; ++k) {
        ivec2 corner = ivec2(k & 1, k >> 1);
        ivec2 texel = clamp(low + corner, 0, u_face_size - 1);
        int index = first + texel.y * u_face_size + texel.x;
        float distance = texelFetch(u_distances, index).x;
        if (distance >= kNothingThere)
            continue;
        vec2 q = (vec2(texel) + 0.5) / float(u_face_size) * 2.0 - 1.0;
        vec3 direction;
        direction[axis] = negative ? -1.0 : 1.0;
        direction[across] = q.x;
        direction[along] = q.y;
        vec3 apart = distance * normalize(direction) - d;
        uint value = texelFetch(u_values, index).x;
        if (abs(dot(apart, normal)) > kPlane * footprint ||
            length(apart) > kReach * footprint / cosine ||
            dot(normal_of(value), normal) < kSameNormal)
            continue;
        vec2 weights = mix(1.0 - share, share, vec2(corner));
        float weight = weights.x * weights.y;
        sum += weight * vec2(float(value & 255u) / 255.0, 1.0);
    }
    return sum;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 seen = texelFetch(u_surface, pixel, 0);
    out_answer = vec2(0.0);
    if (is_background(seen))
        return;
    vec3 point = u_eye + in_world(position_at(pixel, seen));
    vec3 normal = in_world(seen.xyz);

    vec2 blend = vec2(0.0);  // occlusion, all
    vec2 sum = vec2(0.0);
    float most = 0.0;  // the weight of the first that answers
    for (int k = 0; k < u_map_count; ++k) {
        vec4 map = texelFetch(u_maps, 2 * k);
        vec3 d = point - map.xyz;
        float distance = length(d);
        float cosine = -dot(normal, d) / distance;
        vec2 answer = cosine > 0.0 ? read_map(int(map.w), d, normal, cosine) : vec2(0.0);
        if (answer.y >= kLeastWeight) {
            vec3 size = abs(d);
            float quality = cosine * max(size.x, max(size.y, size.z)) / (distance * distance);
            blend += pow(quality, 4.0) * vec2(answer.x / answer.y, 1.0);
        }
        if (blend.y > 0.0) {
            vec2 weight = texelFetch(u_maps, 2 * k + 1).xy;
            sum += weight.x * vec2(blend.x / blend.y, 1.0);
            most = max(most, weight.y);
        }
    }
    if (sum.y > 0.0)
        out_answer = vec2(sum.x / sum.y, min(1.0, most / kWhole));
}
