// mask_raster.glsl: the directions that the bits of a mask stand for; one face of the cube.
//
// All is said in the face's own axes, in which it is always the +x face: (x, y, z) = (axis, U, V) of
// tree/mask_raster.h, the axis turned round for the three backward faces. Sixteen words, one a row,
// as four uvec4: row 4 q + i is component i of element q.
//
// CPU twin   tree/mask_raster.cpp (the same numbers to the last bit), tree/mask_kernel_body.h
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
const float kTinyComponent = 1e-30;

struct Rows {
    uvec4 words[4];
};

// The bits from ceil(t) up.
uvec4 bits_from(vec4 t)
{
    ivec4 first = ivec4(clamp(ceil(t), 0.0, 32.0));
    return (uvec4(0xFFFFFFFFu) << uvec4(first & 31)) * uvec4(lessThan(first, ivec4(32)));
}

// Keeps the bits with n.d >= 0.
void cut(inout Rows rows, vec3 n)
{
    bool  turned = n.y < 0.0;
    float scale  = (turned ? 16.0 : -16.0) / max(abs(n.y), kTinyComponent);
    float slope  = n.z * scale;
    float start  = n.x * scale + 16.0;
    uvec4 below  = uvec4(turned ? 0xFFFFFFFFu : 0u);
    for (int q = 0; q < 4; ++q)
        rows.words[q] &= bits_from(slope * kRowV[q] + start - kRowShift[q]) ^ below;
}

Rows all_bits()
{
    return Rows(uvec4[4](uvec4(0xFFFFFFFFu), uvec4(0xFFFFFFFFu), uvec4(0xFFFFFFFFu),
                         uvec4(0xFFFFFFFFu)));
}
