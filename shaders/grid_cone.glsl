#include "grid_cap.glsl"

// grid_cone.glsl: the cone of moments m / (4 pi), alpha, and what it hides.
//
// Host side  grid/cone.h

// T(h, b) of a cap that hides the share `cap` of the sphere, cosine = cos b. In the open part of the
// horizon it is s^2 max(0, cos b), s = sin h. Across it T(h, b) - T(h, 180 - b) = s^2 cos b, so that an
// even function remains, which is fitted: off by .0011 at most. A table of 64 x 64 was off by .0014 and
// took a quarter more of the processor for a box over the picture: 20.3 against 16.1 ms.
float clipped_cap(float cap, float cosine)
{
    float k = abs(1.0 - 2.0 * cap);  // |cos h|
    float sine2 = 1.0 - k * k, sine = sqrt(sine2);
    float cut = max(0.0, sine2 - cosine * cosine);
    float lost = sine * cut * k * (sine2 + 0.54062 * cut) /
                 (sine2 * (0.24240 + 3.27521 * k) + cut * (2.14261 - 0.36221 * k) + 1e-12);
    float even = 0.5 * sine2 * max(sine, abs(cosine)) - lost;
    return 0.5 * sine2 * cosine + (cap > 0.5 ? 1.0 - even : even);
}

// In [0, 1]. normal: in the moments' directions
float occlusion_by(vec4 moments, vec3 normal)
{
    float square = dot(moments.xyz, moments.xyz);
    float over_length = inversesqrt(max(square, kNothing * kNothing));
    float alpha = clamp(moments.w, kNothing, 1.0);
    // cap_of(), by one division for two: 20.1 -> 19.4 ms of the processor for a box over the picture
    float rest = max(alpha - square * over_length, kNothing * kNothing);
    float over = 1.0 / (alpha * rest);
    float cap = max(alpha, rest * rest * over);
    float covered = min(1.0, alpha * alpha * alpha * over);
    float cosine = dot(moments.xyz, normal) * over_length;
    return moments.w < kNothing ? 0.0 : covered * clipped_cap(cap, cosine);
}
