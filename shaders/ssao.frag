#version 330 core
#include "screen_space.glsl"
#include "screen_noise.glsl"

// ssao.frag: ambient occlusion as the share of samples about the pixel's point that lie behind what
// the picture shows in their place; a wall has half of them in front, which counts as open.
//
//        o   o   o    in front of the picture's depth: visible
//      ____o_p_o____
//        x   x   x    behind: hidden            occlusion = 1 - min(1, 2 x mean)
//
// Based on   Mittring. Finding Next Gen: CryEngine 2. SIGGRAPH courses, 2007, and
//            Kajalin. Screen Space Ambient Occlusion. ShaderX7, 2009
// Departs    the ball is filled evenly (its radius by the cube root); samples come in pairs of
//            opposite ones unless they are asked not to: of each one is in front of a plane, so that
//            a wall is open with few of them, too; what is open beyond a half is cut off; samples
//            outside of the picture are left out, with their partners. Disk: its size on the picture is that of R at
//            the distance u_disc_distance, for near and far pixels alike, as in depth
//
// Vertices   fullscreen.vert
// Reads      screen_space.glsl, screen_noise.glsl
//            u_samples        RGBA32F: offsets in the unit ball, 0; partners behind each other
//            u_pairs          how many
//            u_is_paired      1: partners lie opposite of each other
//            u_disc_distance  0: a ball of view space
//            u_reach          radii: what is nearer to the eye by more says nothing, and counts half
//            u_is_by_ratio    1: in its place, the share of (z_p - z) / z counts half
// Writes     out_occlusion
// CPU twin   tests/screen_twin.cpp
uniform samplerBuffer u_samples;
uniform int u_pairs;
uniform int u_is_paired;
uniform float u_disc_distance;
uniform float u_reach;
uniform int u_is_by_ratio;

// Taken once a pixel (pixel_ray.glsl).
int pairs = u_pairs;
bool is_paired = u_is_paired == 1;
float disc_distance = u_disc_distance;
float reach = u_reach;
bool is_by_ratio = u_is_by_ratio == 1;

out float out_occlusion;

const float kOutside = -1.0;

// Whether the place that so much of the radius leads to is in front of what is seen there: 1, 0, or
// between where what is seen there does not tell; or kOutside. pixels: the radius.
float openness(vec3 offset, vec3 position, float radius, vec2 pixels)
{
    vec3 sampled = position + radius * offset;
    ivec2 pixel = ivec2(floor(disc_distance > 0.0 ? gl_FragCoord.xy + offset.xy * pixels
                                                  : place_of(sampled)));
    if (sampled.z <= 0.0 && !is_orthographic || is_outside(pixel))
        return kOutside;
    float z = distance_at(pixel);
    float nearer = position.z - z;
    float validity = is_by_ratio ? 1.0 - clamp(nearer / z, 0.0, 1.0)
                                 : (nearer <= reach * radius ? 1.0 : 0.0);
    return mix(0.5, z > sampled.z ? 1.0 : 0.0, validity);
}

vec3 mirrored(vec3 offset, vec3 mirror) { return offset - 2.0 * dot(offset, mirror) * mirror; }

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(u_surface, pixel, 0);
    float radius = u_radius;
    if (disc_distance > 0.0 && !is_orthographic)
        radius *= here.w / disc_distance;
    vec2 pixels = radius * pixels_at(here.w);
    out_occlusion = 0.0;
    if (is_background(here) || pixels.y < 1.0)
        return;
    vec3 position = position_at(pixel, here);
    vec2 noise = noise_at(pixel);
    // the z axis is mirrored to any direction, each as often: so does a disk stand for the ball
    float height = 2.0 * noise.x - 1.0, turn = 6.28318531 * noise.y;
    vec3 axis = vec3(sqrt(1.0 - height * height) * vec2(cos(turn), sin(turn)), height);
    vec3 mirror = normalize(axis - vec3(0.0, 0.0, 1.0));
    float open = 0.0, count = 0.0;
    for (int i = 0; i < pairs; ++i) {
        vec3 one = mirrored(texelFetch(u_samples, 2 * i).xyz, mirror), other = -one;
        if (!is_paired)
            other = mirrored(texelFetch(u_samples, 2 * i + 1).xyz, mirror);
        float a = openness(one, position, radius, pixels);
        float b = openness(other, position, radius, pixels);
        vec2 counts = vec2(a == kOutside ? 0.0 : 1.0, b == kOutside ? 0.0 : 1.0);
        if (is_paired)
            counts = vec2(counts.x * counts.y);
        open += dot(counts, vec2(a, b));
        count += counts.x + counts.y;
    }
    out_occlusion = count > 0.0 ? 1.0 - min(1.0, 2.0 * open / count) : 0.0;
}
