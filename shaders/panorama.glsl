// panorama.glsl: light from all around (viewer/environment.h).
//   u_sky_frame  model to panorama directions (y up)
//   u_exposure   factor on the light
uniform mat3 u_sky_frame;
uniform float u_exposure;

const float kPi = 3.14159265358979;

// Twin of panorama_uv in viewer/environment.cpp.
vec2 panorama_uv(vec3 direction)
{
    return vec2(0.5 + atan(direction.z, direction.x) / (2.0 * kPi),
                acos(clamp(direction.y, -1.0, 1.0)) / kPi);
}

// Rolls bright light off towards 1 and leaves what is below 0.6 alone: a choice of taste.
vec3 soften(vec3 light)
{
    vec3 over = max(light - 0.6, 0.0);
    return min(light, 0.6) + 0.4 * (1.0 - exp(-over / 0.4));
}
