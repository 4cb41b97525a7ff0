#include "mask_constants.glsl"
// mask_raster.glsl: the directions that the bits of a mask stand for; one face of the cube.
//
// All is said in the face's own axes, in which it is always the +x face: (x, y, z) = (axis, U, V) of
// tree/masks/raster.h, the axis turned round for the three backward faces. Sixteen words, one a row,
// as four uvec4, the quarters of a face: row 4 q + i is component i of quarter q.
//
// CPU twin   tree/masks/raster.cpp (the same numbers to the last bit), tree/masks/kernel_raster.h
const vec4 kRowV[4] = vec4[4](
    vec4(-0.906347156, -0.741650522, -0.599376917, -0.472964764),
    vec4(-0.357805729, -0.25048697, -0.148335993, -0.0491268486),
    vec4(0.0491268486, 0.148335993, 0.25048697, 0.357805729),
    vec4(0.472964764, 0.599376917, 0.741650522, 0.906347156));
const vec4 kRowShift[4] = vec4[4](
    vec4(0.0, 0.618034005, 0.236067981, 0.854101956),
    vec4(0.472135961, 0.0901699439, 0.708203912, 0.326237917),
    vec4(0.944271922, 0.562305927, 0.180339888, 0.798373878),
    vec4(0.416407853, 0.0344418548, 0.652475834, 0.270509839));

// The bits from ceil(t) up.
uvec4 bits_from(vec4 t)
{
    ivec4 first = ivec4(clamp(ceil(t), 0.0, 32.0));
    return (uvec4(0xFFFFFFFFu) << uvec4(first & 31)) * uvec4(lessThan(first, ivec4(32)));
}

// The half-space n.d >= 0, as the bits of a row from slope v + start - shift up, or those below.
struct Side {
    float slope, start;
    uint below;  // all ones where the bits below are meant
};

Side side_of(vec3 n)
{
    bool  turned = n.y < 0.0;
    float scale  = (turned ? kMaskHalfColumns : -kMaskHalfColumns) / max(abs(n.y), kMaskTiny);
    return Side(n.z * scale, n.x * scale + kMaskHalfColumns, turned ? 0xFFFFFFFFu : 0u);
}

// The bits of quarter q on that side.
uvec4 bits_of(Side side, int q)
{
    return bits_from(side.slope * kRowV[q] + side.start - kRowShift[q]) ^ uvec4(side.below);
}

// The bits of quarter q whose rays meet a plane within the limit: n.d >= k |d| for the plane's
// normal n, k = its distance / limit, 0 <= k < 1 (cone_bits in tree/masks/kernel_raster.h says why).
uvec4 cone_bits(vec3 n, float k, int q)
{
    float a = n.y * n.y - k * k;
    a       = abs(a) < kMaskConeFlat ? (a < 0.0 ? -kMaskConeFlat : kMaskConeFlat) : a;
    vec4  v     = kRowV[q];
    vec4  p     = n.z * v + n.x;
    vec4  root2 = p * p + (v * v + 1.0) * a;
    vec4  root  = sqrt(max(root2, 0.0)) * k;
    vec4  b     = p * n.y;
    float scale = kMaskHalfColumns / a;
    uvec4 first  = bits_from((root - b) * scale - kRowShift[q] + kMaskHalfColumns);
    uvec4 second = bits_from((-root - b) * scale - kRowShift[q] + kMaskHalfColumns);
    if (a > 0.0)
        return n.y > 0.0 ? first : ~second;
    return first & ~second & (uvec4(greaterThan(root2, vec4(0.0))) * 0xFFFFFFFFu) &
           (uvec4(greaterThan(p, vec4(0.0))) * 0xFFFFFFFFu);
}
