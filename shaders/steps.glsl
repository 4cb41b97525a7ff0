// steps.glsl: where the samples of a slice lie.
//
// Host side  gpu/screen_space.h
//   u_power  step k of n lies at R ((k + jitter) / n)^power
#ifndef ANY_POWER
#define ANY_POWER 0
#endif
#if ANY_POWER
uniform float u_power;
#endif

float distance_of_step(int k, float jitter)
{
    float x = (float(k) + jitter) / float(steps);
#if ANY_POWER
    return u_radius * pow(x, u_power);
#else
    return u_radius * x * x;
#endif
}
