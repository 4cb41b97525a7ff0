#version 330 core
#include "rows.glsl"
// row_sums.frag: sums of 64 neighbours of an array in rows, so that little is left to read back.
//
// Vertices   fullscreen.vert, over a target of 64 texels a row
// Drawn by   gpu/gpu_disks.cpp
// Reads      u_values  R32F, in rows (rows.glsl)
// Writes     out_sum   R32F
uniform sampler2D u_values;

out float out_sum;

void main()
{
    const int kTerms = 64;
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float sum   = 0.0;
    for (int i = 0; i < kTerms; ++i)
        sum += texelFetch(u_values, ivec2(texel.x * kTerms + i, texel.y), 0).x;
    out_sum = sum;
}
