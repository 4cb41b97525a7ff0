// shading.glsl: the colour of a surface point, linear light, display-referred.
//
// Right of u_wipe_x (pixels) the reference stands in for the result.
//   u_colors            the value of Colors in viewer/view_options.h; -1: occlusion and that of the
//                       reference as they are, in red and green
//   u_difference_scale  occlusion difference at the end of the colour map
//   u_is_signed         1: the map is the diverging one, its middle no difference
//   u_color_map         a row, colors_of() of image/color_map.h
//   u_irradiance        irradiance_map() of viewer/environment.h, row 0 = sky
//   u_sight             from (pixel, 1) to the direction in which the eye sees it, of any length
#include "panorama.glsl"

uniform int u_colors;
uniform float u_wipe_x;
uniform float u_difference_scale;
uniform int u_is_signed;
uniform sampler2D u_color_map;
uniform sampler2D u_irradiance;
uniform mat3 u_sight;

const float kAlbedo = 0.80;  // of the model in the environment
const float kPaper = 0.94;   // shown value of an open place: not pure white, so that edges show

const int kAsNumbers = -1;
const int kVisibility = 0;
const int kRays = 1;
const int kDifference = 2;
const int kBentNormals = 3;
const int kNormals = 4;
const int kLevels = 5;
const int kEnvironment = 6;
const int kRadius = 11;
const int kHeadlight = 12;

// Twin of map_color in image/color_map.cpp: x = 0 and 1 are the middles of the outer texels.
vec3 map_color(float x)
{
    float steps = float(textureSize(u_color_map, 0).x);
    return texture(u_color_map, vec2((clamp(x, 0.0, 1.0) * (steps - 1.0) + 0.5) / steps, 0.5)).rgb;
}

// Twin of difference_place there.
float difference_place(float difference)
{
    float place = difference / u_difference_scale;
    return u_is_signed == 1 ? 0.5 + 0.5 * place : abs(place);
}

// The linear light that a screen shows as that value (IEC 61966-2-1).
vec3 srgb_decode(vec3 shown)
{
    return mix(pow((shown + 0.055) / 1.055, vec3(2.4)), shown / 12.92,
               lessThanEqual(shown, vec3(0.04045)));
}

vec3 safe_normalize(vec3 v)
{
    float length2 = dot(v, v);
    return length2 > 0.0 ? v * inversesqrt(length2) : vec3(0.0);
}

// A direction as a colour: the shown value is (d + 1) / 2.
vec3 direction_color(vec3 d) { return srgb_decode(0.5 + 0.5 * d); }

// What stands at this pixel: the result, or right of the wipe the reference.
vec4 at_wipe(vec4 own, vec4 reference) { return gl_FragCoord.x < u_wipe_x ? own : reference; }

// Lambert's cosine to a light at the eye, for either side of a surface.
float headlight(vec3 normal)
{
    return abs(dot(safe_normalize(normal), normalize(u_sight * vec3(gl_FragCoord.xy, 1.0))));
}

// normal_level: the normal of what is drawn, and the level of its surfel (model_shape.glsl). own and
// reference: the texels of model_values.glsl.
vec3 shade(vec4 normal_level, vec4 own, vec4 reference)
{
    vec4 values = at_wipe(own, reference);
    if (u_colors == kAsNumbers)
        return vec3(values.w, reference.w, 0.0);
    if (u_colors == kDifference)
        return map_color(difference_place(own.w - reference.w));
    if (u_colors == kBentNormals)
        return direction_color(safe_normalize(values.xyz));
    if (u_colors == kNormals)
        return direction_color(safe_normalize(normal_level.xyz));
    if (u_colors == kLevels)
        return map_color(normal_level.w);
    if (u_colors == kRadius)
        return map_color(values.w);
    float visibility = 1.0 - (u_colors == kRays ? reference.w : values.w);
    if (u_colors == kHeadlight)  // light, not a shown value: an open place that faces the eye is paper
        return srgb_decode(vec3(kPaper)) * visibility * headlight(normal_level.xyz);
    if (u_colors != kEnvironment)  // as the baked colours look in other programs
        return srgb_decode(vec3(kPaper * visibility));
    vec2 uv = panorama_uv(u_sky_frame * safe_normalize(values.xyz));
    return soften(kAlbedo * visibility * u_exposure * textureLod(u_irradiance, uv, 0.0).rgb);
}
