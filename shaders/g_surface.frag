#version 330 core
#include "g_point.glsl"

// g_surface.frag: the surface at the middle of each pixel, of the triangle that is seen there.
//
// Vertices   fullscreen.vert
// Reads      g_point.glsl
//            u_corners    R32UI, three texels per triangle: its wedges (surfels/surface.h)
//            u_normals    RGBA32F, one texel per wedge: normal.xyz 0
// Writes     out_surface   see gpu/g_buffer.h
//            out_distance  its distance alone

uniform usamplerBuffer u_corners;
uniform samplerBuffer u_normals;

layout(location = 0) out vec4 out_surface;
layout(location = 1) out float out_distance;

void main()
{
    uint seen = seen_triangle();
    if (seen == 0u) {
        out_surface = vec4(0.0, 0.0, 0.0, 1e30);
        out_distance = 1e30;
        return;
    }
    int triangle = int(seen - 1u);
    vec3 n[3];
    for (int k = 0; k < 3; ++k)
        n[k] =
            in_view(texelFetch(u_normals, int(texelFetch(u_corners, 3 * triangle + k).r)).xyz);
    SeenPoint point = point_of(triangle);
    vec2 at = point.at;
    vec3 flat_normal = (point.facing < 0.0 ? -1.0 : 1.0) * normalize(point.face);
    vec3 normal = (1.0 - at.x - at.y) * n[0] + at.x * n[1] + at.y * n[2];
    float length_squared = dot(normal, normal);
    normal = length_squared > 0.0 ? normal * inversesqrt(length_squared) : flat_normal;
    if (dot(normal, flat_normal) < 0.0)
        normal = -normal;
    if (dot(normal, point.direction) >= 0.0)
        normal = flat_normal;
    out_surface = vec4(normal, point.z);
    out_distance = point.z;
}
