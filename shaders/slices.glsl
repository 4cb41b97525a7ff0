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
//   u_steps       samples on either side
//   u_turn        cosine and sine of the angle between directions
//   u_per_square  1 / R^2
//   u_is_faded    1: what a sample counts falls smoothly to 0 at R; 0: it counts 1 up to R
uniform int u_steps;
uniform vec2 u_turn;
uniform float u_per_square;
uniform int u_is_faded;

// Taken once a pixel (pixel_ray.glsl).
int steps = u_steps;
vec2 turn = u_turn;
float per_square = u_per_square;
bool is_faded = u_is_faded == 1;

// A surface seen so flatly spans more than 20 times its width in depth per pixel: what moves
// samples into the slice is bounded there.
const float kFlattest = 0.05;

struct Slice {
    vec2 pixels;      // seen per unit of length along `across`
    float nearest;    // length that is seen as one pixel
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
    slice.nearest = inversesqrt(dot(slice.pixels, slice.pixels));
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
    return vec2(direction.x * turn.x - direction.y * turn.y,
                direction.x * turn.y + direction.y * turn.x);
}

// What the picture shows at the distance t along `across`, on the side 1 or -1; at least a pixel
// away. False where that is nothing: outside of the picture, background.
bool sample_at(float t, float side, Slice slice, out vec3 position)
{
    ivec2 pixel =
        ivec2(floor(gl_FragCoord.xy + side * max(t, slice.nearest) * slice.pixels));
    if (is_outside(pixel))
        return false;
    float z = distance_at(pixel);
    position = view_position(vec2(pixel) + 0.5, z);
    return z < kNothingThere;
}

// what a sample at the distance of this square counts
float weight_at(float square)
{
    float rest = max(0.0, 1.0 - square * per_square);
    return is_faded ? rest * rest : (rest > 0.0 ? 1.0 : 0.0);
}

// Integral of cos(a - gamma) |sin a| over the angles a from V down to the cosine c, on the side
// where the normal leans by gamma: g = sin(gamma) there, -sin(gamma) on the other. GTAO's equation
// 7 in terms of the cosine:
//
//     (cos gamma sin^2 a + g (a - sin a cos a)) / 2
//
// a - sin a cos a for c >= 0 as (1 - c)^(3/2) times a fitted polynomial, within 7e-5; below, it is
// pi less that of -c.
float arc(float c, float g, float cos_gamma)
{
    float x = abs(c), rest = max(0.0, 1.0 - x);
    float sector = rest * sqrt(rest) * (1.57086152 + x * (0.35365866 - x * 0.04142777));
    sector = c < 0.0 ? 3.14159265 - sector : sector;
    return 0.5 * (cos_gamma * rest * (1.0 + x) + g * sector);
}
