#version 330 core
#include "slices.glsl"
#include "steps.glsl"

// bitmask.frag: ambient occlusion of slices whose directions are 32 bits: each sample hides those
// between its own angle and that of the point a thickness behind it, and light passes behind.
//
//        V      front . .       bits from the front's angle to the back's are set; what is seen
//        |          .   . back  through between two samples stays open
//     ___|________.___.___
//
// Based on   Therrien, Levesque, Gilet. Screen Space Indirect Lighting with Visibility Bitmask. 2023
// Departs    the bits are not of equal angles but of equal weight, that of the cosine over the
//            normal (gtao.frag's integral): counting them is the answer, and with an endless
//            thickness it is gtao's; ends are rounded to bits up or down, from slice to slice, so
//            that the mean is not; a sample's fade lowers both its ends
//
// Vertices   fullscreen.vert
// Definitions  ANY_POWER: 0 or 1. 0: u_power is 2 (steps.glsl)
// Reads      slices.glsl, steps.glsl
//            u_slices     how many
//            u_thickness  of what is seen, along V, in units of view space
// Writes     out_occlusion
// CPU twin   tests/screen_twin.cpp
uniform int u_slices;
uniform float u_thickness;

// Taken once a pixel (pixel_ray.glsl).
float thickness = u_thickness;

out float out_occlusion;

// from the bit `first` on; first + count <= 32
uint bits_from(int first, int count)
{
    return count == 0 ? 0u : 0xffffffffu >> uint(32 - count) << uint(first);
}

int count_bits(uint bits)
{
    bits -= bits >> 1u & 0x55555555u;
    bits = (bits & 0x33333333u) + (bits >> 2u & 0x33333333u);
    bits = bits + (bits >> 4u) & 0x0f0f0f0fu;
    return int(bits * 0x01010101u >> 24u);
}

// The bits between the front and the back of what is seen at t on that side.
// left: integral of the other half of the slice; dither: in [0, 1), where in a bit ends are rounded
uint bits_at(float t, float side, float left, float bits_per_arc, float dither, Slice slice,
             vec3 position)
{
    vec3 seen;
    if (!sample_at(t, side, slice, seen))
        return 0u;
    vec3 d = seen - position;
    vec2 front = vec2(dot(d, slice.across), dot(d, slice.up));
    float square = dot(front, front);
    float weight = weight_at(square);
    if (weight == 0.0)
        return 0u;
    vec2 back = front - vec2(0.0, thickness);
    float g = side * slice.sin_gamma;
    float high = mix(-g, front.y * inversesqrt(max(square, 1e-30)), weight);
    float low = mix(-g, back.y * inversesqrt(max(dot(back, back), 1e-30)), weight);
    vec2 ends = left + side * vec2(arc(clamp(high, -g, 1.0), g, slice.cos_gamma),
                                   arc(clamp(low, -g, 1.0), g, slice.cos_gamma));
    ivec2 at = ivec2(clamp(ends * bits_per_arc, 0.0, 32.0) + dither);
    return bits_from(min(at.x, at.y), abs(at.x - at.y));
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
    vec2 noise = noise_at(pixel);
    float first = noise.x * 3.14159265 / float(u_slices);
    vec2 direction = vec2(cos(first), sin(first));
    float hidden = 0.0, all = 0.0;
    for (int s = 0; s < u_slices; ++s) {
        Slice slice = slice_of(here.xyz, eye, direction, pixels_per_unit);
        float left = arc(slice.sin_gamma, -slice.sin_gamma, slice.cos_gamma);
        float whole = left + arc(-slice.sin_gamma, slice.sin_gamma, slice.cos_gamma);
        float bits_per_arc = 32.0 / max(whole, 1e-6);
        uint bits = 0u;
        // short of a whole bit: rounding does not lift what lies in the tangent plane
        float dither = 0.001 + 0.998 * fract(noise.x + float(s) * 0.618033989);
        for (int k = 0; k < steps; ++k) {
            float t = distance_of_step(k, noise.y);
            bits |= bits_at(t, 1.0, left, bits_per_arc, dither, slice, position) |
                    bits_at(t, -1.0, left, bits_per_arc, dither, slice, position);
        }
        hidden += slice.share * whole * float(count_bits(bits)) / 32.0;
        all += slice.share * whole;
        direction = turned(direction);
    }
    out_occlusion = all > 0.0 ? clamp(hidden / all, 0.0, 1.0) : 0.0;
}
