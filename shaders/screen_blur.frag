#version 330 core
#include "g_buffer.glsl"

// screen_blur.frag: the mean of the 5 x 5 pixels about each that show the same surface: near the
// pixel's plane, under much the same normal. 0 on the background.
//
// Vertices   fullscreen.vert
// Reads      g_buffer.glsl
//            u_occlusion  R32F as large
//            u_beside     how far beside the plane, in units of view space
// Writes     out_occlusion
// CPU twin   tests/screen_twin.cpp
uniform sampler2D u_occlusion;
uniform float u_beside;

out float out_occlusion;

// cosine between normals of one surface: 37 degrees
const float kMuchTheSame = 0.8;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(u_surface, pixel, 0);
    out_occlusion = 0.0;
    if (is_background(here))
        return;
    vec3 position = position_at(pixel, here);
    float sum = 0.0, count = 0.0;
    for (int y = max(pixel.y - 2, 0); y <= min(pixel.y + 2, u_size.y - 1); ++y) {
        for (int x = max(pixel.x - 2, 0); x <= min(pixel.x + 2, u_size.x - 1); ++x) {
            vec4 texel = texelFetch(u_surface, ivec2(x, y), 0);
            vec3 d = position_at(ivec2(x, y), texel) - position;
            if (!is_background(texel) && abs(dot(d, here.xyz)) < u_beside &&
                dot(here.xyz, texel.xyz) > kMuchTheSame) {
                sum += texelFetch(u_occlusion, ivec2(x, y), 0).r;
                count += 1.0;
            }
        }
    }
    out_occlusion = count > 0.0 ? sum / count : texelFetch(u_occlusion, pixel, 0).r;
}
