#version 330 core
#include "dynamic_radius.glsl"
#include "screen_noise.glsl"

// vo.frag: volumetric obscurance: lines along the view through a ball about the pixel's point, each
// free down to what the picture shows in its place.
//
//        .-|-.        half length s = sqrt(1 - x^2 - y^2), d = depth of the picture behind the
//       /  |  \       point, in radii:    free = max(min(s, d) + s, 0)     of 2 s
//      |   p  _|_     open = sum of volume x free / 2 s over the lines
//       \_/|__/       occlusion = 1 - min(1, 2 x open)
//        '-|-'
//
// A line that meets something nearer than the reach knows nothing: it has what its partner, opposite
// of the point, has not; as if both lay on a plane.
//
// Based on   Loos, Sloan. Volumetric Obscurance. 2010, and
//            Ownby, Hall, Hall. Rendering techniques in Toy Story 3. SIGGRAPH courses, 2010
// Departs    a line outside of the picture has its partner's rest too; with both outside neither
//            counts; both beyond the reach are half free
//
// Vertices   fullscreen.vert
// Reads      dynamic_radius.glsl, screen_noise.glsl
//            u_samples    RGBA32F: x, y in the unit disk, s, volume; partners behind each other
//            u_pairs      how many
//            u_is_paired  1: partners lie opposite of each other; 0: a line that knows nothing is
//                         half free
//            u_reach      radii
//            u_dual       0: R alone; 1: product of what is open at R and at R / 2; 2: minimum
// Writes     out_occlusion
// CPU twin   tests/screen_twin.cpp
uniform samplerBuffer u_samples;
uniform int u_pairs;
uniform int u_is_paired;
uniform float u_reach;
uniform int u_dual;

// Taken once a pixel (pixel_ray.glsl).
int pairs = u_pairs;
bool is_paired = u_is_paired == 1;
float reach = u_reach;

out float out_occlusion;

const float kTooNear = -1.0;
const float kOutside = -2.0;

// of a line at that many pixels from the point; or kTooNear, kOutside
float free_length(vec2 offset, float half_length, float z, float radius)
{
    ivec2 pixel = ivec2(floor(gl_FragCoord.xy + offset));
    if (is_outside(pixel))
        return kOutside;
    float depth = (distance_at(pixel) - z) / radius;
    return depth < -reach ? kTooNear : max(min(half_length, depth) + half_length, 0.0);
}

// Open share of the ball, doubled and cut at 1. turn: cosine and sine
float open_share(float z, float radius, vec2 turn)
{
    vec2 pixels = radius * pixels_at(z);
    if (pixels.y < 1.0)
        return 1.0;
    float sum = 0.0, volume = 0.0;
    for (int i = 0; i < pairs; ++i) {
        vec4 one = texelFetch(u_samples, 2 * i);
        vec4 other = vec4(-one.xy, one.zw);
        if (!is_paired)
            other = texelFetch(u_samples, 2 * i + 1);
        vec4 xy = vec4(one.x * turn.x - one.y * turn.y, one.x * turn.y + one.y * turn.x,
                       other.x * turn.x - other.y * turn.y, other.x * turn.y + other.y * turn.x);
        float a = free_length(xy.xy * pixels, one.z, z, radius);
        float b = free_length(xy.zw * pixels, other.z, z, radius);
        float free_a = a >= 0.0 ? a : one.z, free_b = b >= 0.0 ? b : other.z;
        vec2 counts = vec2(a == kOutside ? 0.0 : 1.0, b == kOutside ? 0.0 : 1.0);
        if (is_paired) {
            free_a = a < 0.0 && b >= 0.0 ? 2.0 * one.z - b : free_a;
            free_b = b < 0.0 && a >= 0.0 ? 2.0 * one.z - a : free_b;
            counts = vec2(max(counts.x, counts.y));
        }
        vec2 volumes = counts * vec2(one.w, other.w);
        sum += dot(volumes, vec2(free_a / one.z, free_b / other.z));
        volume += volumes.x + volumes.y;
    }
    return volume > 0.0 ? min(1.0, sum / volume) : 1.0;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(u_surface, pixel, 0);
    out_occlusion = 0.0;
    if (is_background(here))
        return;
    float radius = chosen_radius(position_at(pixel, here));
    float angle = noise_at(pixel).x * 3.14159265;
    vec2 turn = vec2(cos(angle), sin(angle));
    float open = open_share(here.w, radius, turn);
    if (u_dual != 0) {
        float near = open_share(here.w, 0.5 * radius, turn);
        open = u_dual == 1 ? open * near : min(open, near);
    }
    out_occlusion = 1.0 - open;
}
