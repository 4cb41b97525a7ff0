#version 330 core
#include "g_point.glsl"

// g_values.frag: values of triangles at the pixels that see them.
//
// Vertices   fullscreen.vert
// Reads      g_point.glsl
//            u_values      RGBA32F, one texel per triangle: at its corners, and one of its own
//            u_background  where nothing is seen
// Writes     out_values  interpolated; the triangle's own

uniform samplerBuffer u_values;
uniform vec2 u_background;

out vec2 out_values;

void main()
{
    uint seen = seen_triangle();
    if (seen == 0u) {
        out_values = u_background;
        return;
    }
    int triangle = int(seen - 1u);
    vec4 values = texelFetch(u_values, triangle);
    vec2 at = point_of(triangle).at;
    out_values = vec2((1.0 - at.x - at.y) * values.x + at.x * values.y + at.y * values.z, values.w);
}
