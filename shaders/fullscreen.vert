#version 330 core
// fullscreen.vert: one triangle that covers the viewport, so that a fragment shader runs per pixel.
//
// Drawn by   draw_fullscreen (gpu/draw.h): three vertices, no attributes
// Writes     v_uv   vec2, (0, 0) at the lower left corner of the viewport, (1, 1) at the upper right

out vec2 v_uv;

void main()
{
    v_uv        = vec2((gl_VertexID & 1) * 2, gl_VertexID & 2);
    gl_Position = vec4(2.0 * v_uv - 1.0, 0.0, 1.0);
}
