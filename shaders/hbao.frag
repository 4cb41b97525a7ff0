#version 330 core
#include "slices.glsl"

// hbao.frag: ambient occlusion by marching the picture in directions about the pixel: what each
// higher horizon adds to the sine of its angle over the tangent plane, the nearer the more.
//
//              . S2        sin h of S1, then of S2, over sin(t + bias):
//        . S1              occlusion of the direction = W1 (sin h1 - sin(t + bias))
//     p _________ h, t                                + W2 (sin h2 - sin h1)
//
// Based on   Bavoil, Sainz, Dimitrov. Image-Space Horizon-Based Ambient Occlusion. 2008
// Departs    a sample below the bias over the tangent plane counts nothing, and one above it counts
//            from the bias on, as in the vendor's program; angles are told by their cosines
//
// Vertices   fullscreen.vert
// Reads      slices.glsl
//            u_directions      how many, all round
//            u_bias            cosine and sine of the bias
//            u_has_own_fade    1: W = 1 - (L / R)^2, as published; 0: as u_is_faded says
//            u_has_normals     1: the tangent plane is that of the normal; 0: of the four pixels
//                              around
// Writes     out_occlusion
// CPU twin   tests/screen_twin.cpp
uniform int u_directions;
uniform vec2 u_bias;
uniform int u_has_own_fade;
uniform int u_has_normals;

out float out_occlusion;

// From the pixel to its neighbour on one side or against that on the other, whichever is nearer in
// depth; zero where neither is there.
vec3 tangent(ivec2 pixel, ivec2 step, vec3 position)
{
    vec3 shortest = vec3(0.0);
    float least = kNothingThere;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 beside = pixel + side * step;
        if (is_outside(beside))
            continue;
        vec4 texel = texelFetch(u_surface, beside, 0);
        if (is_background(texel))
            continue;
        vec3 d = float(side) * (position_at(beside, texel) - position);
        if (abs(d.z) < least) {
            shortest = d;
            least = abs(d.z);
        }
    }
    return shortest;
}

// of the picture's depth, towards the eye; `normal` where the neighbours tell none
vec3 normal_of_depth(ivec2 pixel, vec3 position, vec3 eye, vec3 normal)
{
    vec3 face = cross(tangent(pixel, ivec2(1, 0), position), tangent(pixel, ivec2(0, 1), position));
    float square = dot(face, face);
    if (square == 0.0)
        return normal;
    face *= inversesqrt(square);
    return dot(face, eye) < 0.0 ? -face : face;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(u_surface, pixel, 0);
    vec2 pixels_per_unit = pixels_at(here.w);
    out_occlusion = 0.0;
    if (is_background(here) || u_radius * pixels_per_unit.y < 1.0)
        return;
    vec3 position = position_at(pixel, here), eye = to_eye(position);
    vec3 normal = here.xyz;
    if (u_has_normals == 0)
        normal = normal_of_depth(pixel, position, eye, normal);
    vec2 noise = noise_at(pixel);
    float first = noise.x * 6.28318531 / float(u_directions);
    vec2 direction = vec2(cos(first), sin(first));
    float occlusion = 0.0;
    for (int i = 0; i < u_directions; ++i) {
        Slice slice = slice_of(normal, eye, direction, pixels_per_unit);
        // sine of the tangent's angle and the bias, at most a right angle
        float low = -slice.sin_gamma;
        float best = slice.cos_gamma * u_bias.x > low * u_bias.y
                         ? low * u_bias.x + slice.cos_gamma * u_bias.y
                         : 1.0;
        for (int k = 0; k < steps; ++k) {
            vec3 seen;
            if (!sample_at(u_radius * (float(k) + noise.y) / float(steps), 1.0, slice, seen))
                continue;
            vec2 d = vec2(dot(seen - position, slice.across), dot(seen - position, slice.up));
            float square = dot(d, d);
            float c = d.y * inversesqrt(max(square, 1e-30));
            float fade = max(0.0, 1.0 - square * per_square);
            float weight = u_has_own_fade == 1 ? fade : weight_at(square);
            if (weight > 0.0 && c > best) {
                occlusion += weight * (c - best);
                best = c;
            }
        }
        direction = turned(direction);
    }
    out_occlusion = clamp(occlusion / float(u_directions), 0.0, 1.0);
}
