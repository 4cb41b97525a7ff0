#version 330 core

// sum.frag: a picture times a factor: for the sum of several, and for their mean on a screen.
//
// Vertices   fullscreen.vert
// Reads      u_image   as large as the viewport, linear light
//            u_corner  lower left corner of the viewport
//            u_factor
//            u_encode  1: the result is encoded as sRGB (IEC 61966-2-1); 0: it stays linear
// Writes     out_color

uniform sampler2D u_image;
uniform ivec2 u_corner;
uniform float u_factor;
uniform int u_encode;

out vec4 out_color;

void main()
{
    vec4 value = u_factor * texelFetch(u_image, ivec2(gl_FragCoord.xy) - u_corner, 0);
    vec3 shown = mix(1.055 * pow(max(value.rgb, 0.0), vec3(1.0 / 2.4)) - 0.055, 12.92 * value.rgb,
                     lessThanEqual(value.rgb, vec3(0.0031308)));
    out_color = u_encode == 1 ? vec4(shown, value.a) : value;
}
