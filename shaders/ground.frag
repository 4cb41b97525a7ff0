#version 330 core

// ground.frag: the ground takes light from the background where the model shades it, and nothing
// else: it has no colour and no edge of its own.
//
// Vertices   ground.vert
// Reads      u_occlusion  RG32F, (kGroundCells + 1)^2: occlusion, the same by rays
//            u_wipe_x     right of it (pixels) the rays are shown
// Writes     out_color    black, alpha = share of the light that is taken

uniform sampler2D u_occlusion;
uniform float u_wipe_x;

in vec2 v_place;
out vec4 out_color;

void main()
{
    // receivers lie on the texels' middles
    vec2 size = vec2(textureSize(u_occlusion, 0));
    vec2 values = texture(u_occlusion, (v_place * (size - 1.0) + 0.5) / size).rg;
    float occlusion = gl_FragCoord.x < u_wipe_x ? values.r : values.g;
    float from_middle = length(2.0 * v_place - 1.0);
    out_color = vec4(0.0, 0.0, 0.0, occlusion * (1.0 - smoothstep(0.6, 1.0, from_middle)));
}
