#include "screen_space.glsl"
#include "screen_noise.glsl"

// slices.glsl: planes through a pixel's point and the eye, and what of the picture stands in them.
//
//            V, to the eye        a sample seen at the place x over `across` stands at the angle
//            |      . sample      acos(c) from V, c = y / sqrt(x^2 + y^2). Higher c hides more.
//          y |   .
//     _______|._______ across     The picture has pixels: a sample lies up to half a pixel beside
//            x                    the plane. It is moved into it along the receiver's own plane,
//                                 y = d.V + slope d.axis: what lies in the receiver's plane stays
//                                 in it, and a plane is open at every tilt.
//
// Host side  gpu/screen_space.h
//   u_steps     samples on either side
//   u_turn      cosine and sine of the angle between directions
//   u_is_faded  1: what a sample counts falls smoothly to 0 at R; 0: it counts 1 up to R
uniform int u_steps;
uniform vec2 u_turn;
uniform int u_is_faded;

// A surface seen so flatly spans more than 20 times its width in depth per pixel: what moves
// samples into the slice is bounded there.
const float kFlattest = 0.05;

struct Slice {
    vec2 pixels;      // seen per unit of length along `across`
    vec3 across;      // unit length, at right angles to V
    vec3 up;          // d.up is the height y of a sample
    float share;      // length of the normal's part in the slice
    float sin_gamma;  // of that part's angle from V, towards `across`
    float cos_gamma;
};

// direction: in the picture, unit length
Slice slice_of(vec3 normal, vec3 eye, vec2 direction, vec2 pixels_per_unit)
{
    Slice slice;
    slice.pixels = direction * pixels_per_unit;
    vec3 along = vec3(direction, 0.0);
    slice.across = normalize(along - dot(along, eye) * eye);
    vec3 axis = cross(eye, slice.across);
    float towards_eye = dot(normal, eye), x = dot(normal, slice.across);
    slice.up = eye + dot(normal, axis) / max(towards_eye, kFlattest) * axis;
    slice.share = length(vec2(x, towards_eye));
    slice.sin_gamma = slice.share > 0.0 ? x / slice.share : 0.0;
    slice.cos_gamma = slice.share > 0.0 ? max(towards_eye, 0.0) / slice.share : 1.0;
    return slice;
}

vec2 turned(vec2 direction)
{
    return vec2(direction.x * u_turn.x - direction.y * u_turn.y,
                direction.x * u_turn.y + direction.y * u_turn.x);
}

// What the picture shows at the distance t along `across`, t of either sign; at least a pixel away.
// False where that is nothing: outside of the picture, background.
bool sample_at(float t, Slice slice, out vec3 position)
{
    vec2 offset = t * slice.pixels;
    float away = dot(offset, offset);
    offset *= away < 1.0 ? inversesqrt(max(away, 1e-20)) : 1.0;
    ivec2 pixel = ivec2(floor(gl_FragCoord.xy + offset));
    if (is_outside(pixel))
        return false;
    vec4 texel = texelFetch(u_surface, pixel, 0);
    position = position_at(pixel, texel);
    return !is_background(texel);
}

// what a sample at the distance of this square counts
float weight_at(float distance_squared)
{
    float rest = max(0.0, 1.0 - distance_squared / (u_radius * u_radius));
    return u_is_faded == 1 ? rest * rest : (rest > 0.0 ? 1.0 : 0.0);
}

// within 7e-5 for x in [-1, 1]: Abramowitz, Stegun, "Handbook of Mathematical Functions", 4.4.45
float angle_of(float x)
{
    float y = abs(x);
    float angle = sqrt(max(0.0, 1.0 - y)) *
                  (1.5707288 + y * (-0.2121144 + y * (0.0742610 - y * 0.0187293)));
    return x < 0.0 ? 3.14159265 - angle : angle;
}

// Integral of cos(a - gamma) |sin a| over the angles a from V down to the cosine c, on the side
// where the normal leans by gamma: g = sin(gamma) there, -sin(gamma) on the other. (GTAO, equation
// 7, in terms of the cosine.)
float arc(float c, float g, float cos_gamma)
{
    float square = max(0.0, 1.0 - c * c);
    return 0.5 * (cos_gamma * square + g * (angle_of(c) - c * sqrt(square)));
}
