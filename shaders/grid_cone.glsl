#include "grid_cap.glsl"

// grid_cone.glsl: the cone of moments m / (4 pi), alpha, and what it hides.
//
// Host side  grid/cone.h
//   u_caps  R32F, 64 x 64: T of caps that hide the share x of the sphere, y = (1 + cos b) / 2
uniform sampler2D u_caps;

// In [0, 1]. normal: in the moments' directions
float occlusion_by(vec4 moments, vec3 normal)
{
    float square = dot(moments.xyz, moments.xyz);
    float over_length = inversesqrt(max(square, kNothing * kNothing));
    float alpha = clamp(moments.w, kNothing, 1.0);
    float cap = max(alpha, 1.0 - square * over_length / alpha);
    vec2 place = vec2(cap, 0.5 * dot(moments.xyz, normal) * over_length) * (63.0 / 64.0) +
                 vec2(0.5 / 64.0, 0.5);
    return moments.w < kNothing ? 0.0 : alpha / cap * texture(u_caps, place).r;
}
