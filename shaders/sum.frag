#version 330 core

// sum.frag: a picture times a factor: for the sum of several, and for their mean on a screen.
//
// Vertices   fullscreen.vert
// Reads      u_image   linear light; its texels are u_texel pixels wide, blended where that is not 1
//            u_texel
//            u_corner  lower left corner of the viewport
//            u_factor
//            u_encode  1: for a screen: encoded as sRGB (IEC 61966-2-1), before checks where it is
//                      transparent; 0: it stays linear
// Writes     out_color

uniform sampler2D u_image;
uniform int u_texel;
uniform ivec2 u_corner;
uniform float u_factor;
uniform int u_encode;

out vec4 out_color;

vec4 image_at(ivec2 pixel)
{
    if (u_texel == 1)
        return texelFetch(u_image, pixel, 0);
    vec2 place = (vec2(pixel) + 0.5) / float(u_texel) - 0.5;
    vec2 share = fract(place);
    ivec2 last = textureSize(u_image, 0) - 1;
    ivec2 low = clamp(ivec2(floor(place)), ivec2(0), last);
    ivec2 high = clamp(ivec2(floor(place)) + 1, ivec2(0), last);
    return mix(mix(texelFetch(u_image, low, 0), texelFetch(u_image, ivec2(high.x, low.y), 0), share.x),
               mix(texelFetch(u_image, ivec2(low.x, high.y), 0), texelFetch(u_image, high, 0), share.x),
               share.y);
}

vec3 checks(ivec2 pixel)
{
    const int kCheck = 12;
    ivec2 check = pixel / kCheck;
    return vec3((check.x + check.y) % 2 == 0 ? 0.10 : 0.14);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - u_corner;
    vec4 value = u_factor * image_at(pixel);
    if (u_encode == 1)
        value = vec4(value.rgb + (1.0 - value.a) * checks(pixel), 1.0);
    vec3 shown = mix(1.055 * pow(max(value.rgb, 0.0), vec3(1.0 / 2.4)) - 0.055, 12.92 * value.rgb,
                     lessThanEqual(value.rgb, vec3(0.0031308)));
    out_color = u_encode == 1 ? vec4(shown, value.a) : value;
}
