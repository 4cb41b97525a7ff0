#version 330 core
#include "panorama.glsl"

// background.frag: what is behind the model: a soft gradient, or the environment out of focus.
//
// Vertices   fullscreen.vert
// Reads      panorama.glsl
//            u_show_sky    1: the environment; 0: the gradient
//            u_sky         the panorama with mipmaps, row 0 = sky
//            u_sky_level   which mipmap: how far out of focus
//            u_to_world    clip space to unit frame, inverse of the view projection
//            u_eye         unit frame
// Writes     out_color  linear, opaque

uniform int u_show_sky;
uniform sampler2D u_sky;
uniform float u_sky_level;
uniform mat4 u_to_world;
uniform vec3 u_eye;

in vec2 v_uv;
out vec4 out_color;

void main()
{
    if (u_show_sky == 1) {
        vec4 far = u_to_world * vec4(2.0 * v_uv - 1.0, 1.0, 1.0);
        vec3 direction = normalize(u_sky_frame * (far.xyz / far.w - u_eye));
        vec3 light = u_exposure * textureLod(u_sky, panorama_uv(direction), u_sky_level).rgb;
        out_color = vec4(soften(light), 1.0);
        return;
    }
    const vec3 kTop = vec3(0.150, 0.162, 0.180);
    const vec3 kBottom = vec3(0.420, 0.425, 0.430);
    vec2 from_middle = v_uv - 0.5;
    float vignette = 1.0 - 0.35 * dot(from_middle, from_middle);
    out_color = vec4(mix(kBottom, kTop, smoothstep(0.0, 1.0, v_uv.y)) * vignette, 1.0);
}
