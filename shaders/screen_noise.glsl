// screen_noise.glsl: how the samples of neighbouring pixels differ.
//
// Host side  gpu/screen_space.h
//   u_noise       RG32F, 64 x 64 pairs in [0, 1): gpu/screen_samples.h
//   u_noise_mask  a pixel takes the texel (x & mask, y & mask); -1: interleaved gradient noise
//   u_phase       of the frame, added to either number of the noise
uniform sampler2D u_noise;
uniform int u_noise_mask;
uniform vec2 u_phase;

// in [0, 1): Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014:
// fract(52.9829189 fract(0.06711056 x + 0.00583715 y)), as whole numbers of 2^-32 so that every
// device finds the same
float gradient_noise(ivec2 pixel)
{
    uint inner = uint(pixel.x) * 288237660u + uint(pixel.y) * 25070367u;
    uint outer = inner * 53u - (inner >> 16u) * 1119u;
    return float(outer >> 8u) / 16777216.0;
}

// two numbers in [0, 1)
vec2 noise_at(ivec2 pixel)
{
    vec2 noise = u_noise_mask < 0 ? vec2(gradient_noise(pixel),
                                         gradient_noise(pixel + ivec2(37, 11)))
                                  : texelFetch(u_noise, pixel & u_noise_mask, 0).xy;
    return fract(noise + u_phase);
}
