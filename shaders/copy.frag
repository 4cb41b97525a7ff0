#version 330 core
// copy.frag: a texture onto the target, stretched to the viewport.
//
// Vertices   fullscreen.vert
// Reads      u_image  sampler2D, filtered as it was made
// Writes     out_color  the texture's value

uniform sampler2D u_image;

in vec2 v_uv;
out vec4 out_color;

void main() { out_color = texture(u_image, v_uv); }
