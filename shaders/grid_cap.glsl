// grid_cap.glsl: the cap of a cone of moments m / (4 pi), alpha.
//
// Host side  grid/cone.h
const float kNothing = 1e-7;

// share of the sphere that the cap has | how much of it is covered
vec2 cap_of(vec4 moments)
{
    float alpha = clamp(moments.w, kNothing, 1.0);
    float cap = max(alpha, 1.0 - length(moments.xyz) / alpha);
    return vec2(cap, alpha / cap);
}

