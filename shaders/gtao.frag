#version 330 core
#include "slices.glsl"
#include "steps.glsl"

// gtao.frag: ambient occlusion of slices: in each the two highest angles at which the picture stands
// over the pixel's point, and between them the integral of the cosine, in closed form.
//
//            V  n
//      h0 .  | /  . h1       open = share of n in the slice x integral from h0 to h1 of
//          \ |/ /            cos(a - gamma) |sin a| da
//       ____\o/____
//
// Based on   Jimenez, Wu, Pesce, Jarabo. Practical Real-Time Strategies for Accurate Indirect
//            Occlusion. 2016
// Departs    samples lie at the radius times (k / n)^power; none is thought to be thin; the sum is
//            divided by that of open slices, so that a plane is open with any number of them; a
//            sample's fade lowers its cosine towards the tangent plane's
//
// Vertices   fullscreen.vert
// Definitions  ANY_POWER: 0 or 1. 0: u_power is 2 (steps.glsl)
// Reads      slices.glsl, steps.glsl
//            u_slices  how many
// Writes     out_occlusion
// CPU twin   tests/screen_twin.cpp
uniform int u_slices;

out float out_occlusion;

// the higher one of `best` and the cosine of what is seen at t on that side; `low`: the tangent's
float higher(float best, float low, float t, float side, Slice slice, vec3 position)
{
    vec3 seen;
    if (!sample_at(t, side, slice, seen))
        return best;
    vec2 d = vec2(dot(seen - position, slice.across), dot(seen - position, slice.up));
    float square = dot(d, d);
    float weight = weight_at(square);
    float c = d.y * inversesqrt(max(square, 1e-30));
    return max(best, weight > 0.0 ? mix(low, c, weight) : low);
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
        float g = slice.sin_gamma;
        vec2 best = vec2(-g, g);
        for (int k = 0; k < steps; ++k) {
            float t = distance_of_step(k, noise.y);
            best.x = higher(best.x, -g, t, 1.0, slice, position);
            best.y = higher(best.y, g, t, -1.0, slice, position);
        }
        best = min(best, 1.0);
        float whole = arc(-g, g, slice.cos_gamma) + arc(g, -g, slice.cos_gamma);
        float open = arc(best.x, g, slice.cos_gamma) + arc(best.y, -g, slice.cos_gamma);
        hidden += slice.share * (whole - open);
        all += slice.share * whole;
        direction = turned(direction);
    }
    out_occlusion = all > 0.0 ? clamp(hidden / all, 0.0, 1.0) : 0.0;
}
