#version 330 core
#include "grid_cell.glsl"
#include "grid_cap.glsl"

// grid_merge.frag: the cone of one more object, joined to that of those before it.
//
// Vertices   grid_box.vert
// Definitions  SH RESCALE ORTHOGRAPHIC LIFT OWN: GridStore::sh, GridBorder::rescale, Lens,
//            PlacedGrid::lift, GridPass::draw()
// Reads      grid_cell.glsl, grid_cap.glsl
//            u_before  RGBA32F: m / (4 pi) in view space and alpha of the objects before
// Writes     out_moments  the same with this one
// CPU twin   merged() in pixels/placed_grid.cpp

uniform sampler2D u_before;

out vec4 out_moments;

const float kPi = 3.14159265358979;

float angle_of(float cosine) { return acos(clamp(cosine, -1.0, 1.0)); }

// Of the sphere, by caps of these cosines; shared_by_caps() in grid/cone.cpp, but for 4 pi.
float shared_by_caps(float cos_first, float cos_second, float cos_between)
{
    float first = angle_of(cos_first), second = angle_of(cos_second);
    float between = angle_of(cos_between);
    if (between >= first + second)
        return 0.0;
    if (between <= abs(first - second))
        return 0.5 * (1.0 - max(cos_first, cos_second));
    if (between + first + second >= 2.0 * kPi)
        return -0.5 * (cos_first + cos_second);
    float sine1 = sin(first), sine2 = sin(second), sine = sin(between);
    return (kPi - angle_of((cos_between - cos_first * cos_second) / (sine1 * sine2)) -
            cos_first * angle_of((cos_second - cos_between * cos_first) / (sine * sine1)) -
            cos_second * angle_of((cos_first - cos_between * cos_second) / (sine * sine2))) /
           (2.0 * kPi);
}

vec4 merged(vec4 a, vec4 b)
{
    if (a.w < kNothing)
        return b;
    if (b.w < kNothing)
        return a;
    vec2 cap_a = cap_of(a), cap_b = cap_of(b);
    float lengths = length(a.xyz) * length(b.xyz);
    float cosine = lengths > 0.0 ? dot(a.xyz, b.xyz) / lengths : 0.0;
    float shared_part = cap_a.y * cap_b.y *
                        shared_by_caps(1.0 - 2.0 * cap_a.x, 1.0 - 2.0 * cap_b.x, cosine);
    float of_a = cap_b.x / (cap_a.x + cap_b.x);
    vec3 mean = mix(b.xyz / b.w, a.xyz / a.w, of_a);
    return vec4(a.xyz + b.xyz - shared_part * mean, clamp(a.w + b.w - shared_part, 0.0, 1.0));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 seen = texelFetch(u_surface, pixel, 0);
    vec3 x = place_in_box(seen.w, v_to_grid * seen.xyz);
    vec4 before = texelFetch(u_before, pixel, 0);
    out_moments = before;
    if (!(farthest_out(x) <= 1.0) || is_own_pixel())
        return;
    vec4 own = moments_at(x);
    out_moments = merged(before, vec4(transpose(v_to_grid) * own.xyz, own.w));
}
