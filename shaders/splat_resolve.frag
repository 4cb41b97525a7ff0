#version 330 core

// splat_resolve.frag: summed splats become a surface.
//
// Vertices   fullscreen.vert
// Reads      u_sum    sum of weight * (colour, 1) of the splats in front, as large as the target
//            u_depth  their depth; 1 = no splat
// Writes     out_color  the weighted mean, opaque; gl_FragDepth

uniform sampler2D u_sum;
uniform sampler2D u_depth;

out vec4 out_color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(u_sum, pixel, 0);
    if (sum.a <= 0.0)
        discard;
    out_color = vec4(sum.rgb / sum.a, 1.0);
    gl_FragDepth = texelFetch(u_depth, pixel, 0).r;
}
