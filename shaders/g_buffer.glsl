#include "pixel_ray.glsl"

// g_buffer.glsl: what a picture sees.
//
// Host side  gpu/g_buffer.h
//   u_surface  RGBA32F as large as the picture: normal in view space, distance forward; the
//              background is (0, 0, 0, 1e30)
uniform sampler2D u_surface;

const float kNothingThere = 1e30;

bool is_background(vec4 texel) { return texel.w >= kNothingThere; }

vec3 position_at(ivec2 pixel, vec4 texel) { return view_position(vec2(pixel) + 0.5, texel.w); }
