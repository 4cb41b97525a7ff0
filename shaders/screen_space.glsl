#include "g_buffer.glsl"

// screen_space.glsl: what the screen-space methods share.
//
// Host side  gpu/screen_space.h
//   u_radius    R, in units of view space
//   u_distance  R32F: the distances of u_surface alone; software fetches them in half the time
uniform float u_radius;
uniform sampler2D u_distance;

float distance_at(ivec2 pixel) { return texelFetch(u_distance, pixel, 0).r; }

// pixels that a unit of length spans at the distance z, each way
vec2 pixels_at(float z)
{
    vec2 scale = vec2(u_size) / (u_lens_high - u_lens_low);
    return u_is_orthographic == 1 ? scale : scale / z;
}

bool is_outside(ivec2 pixel) { return any(greaterThanEqual(uvec2(pixel), uvec2(picture_size))); }
