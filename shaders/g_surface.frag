#version 330 core
#include "pixel_ray.glsl"

// g_surface.frag: the surface at the middle of each pixel, of the triangle that is seen there.
//
// Vertices   fullscreen.vert
// Reads      pixel_ray.glsl
//            u_seen       R32UI: 1 + triangle, 0 where there is none
//            u_positions  RGBA32F, one texel per vertex: position.xyz 0
//            u_triangles  R32UI, three texels per triangle: its vertices
//            u_corners    R32UI, three texels per triangle: its wedges (surfels/surface.h)
//            u_normals    RGBA32F, one texel per wedge: normal.xyz 0
//            u_eye u_right u_up u_forward  View
// Writes     out_surface   see gpu/g_buffer.h
//            out_distance  its distance alone

uniform usampler2D u_seen;
uniform samplerBuffer u_positions;
uniform usamplerBuffer u_triangles;
uniform usamplerBuffer u_corners;
uniform samplerBuffer u_normals;
uniform vec3 u_eye;
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec3 u_forward;

layout(location = 0) out vec4 out_surface;
layout(location = 1) out float out_distance;

vec3 in_view(vec3 v) { return vec3(dot(v, u_right), dot(v, u_up), dot(v, u_forward)); }

void main()
{
    uint seen = texelFetch(u_seen, ivec2(gl_FragCoord.xy), 0).r;
    if (seen == 0u) {
        out_surface = vec4(0.0, 0.0, 0.0, 1e30);
        out_distance = 1e30;
        return;
    }
    int first = 3 * int(seen - 1u);
    vec3 p[3], n[3];
    for (int k = 0; k < 3; ++k) {
        p[k] = in_view(
            texelFetch(u_positions, int(texelFetch(u_triangles, first + k).r)).xyz - u_eye);
        n[k] = in_view(texelFetch(u_normals, int(texelFetch(u_corners, first + k).r)).xyz);
    }
    vec2 q = lens_place(gl_FragCoord.xy);
    vec3 origin = u_is_orthographic == 1 ? vec3(q, 0.0) : vec3(0.0);
    vec3 direction = u_is_orthographic == 1 ? vec3(0.0, 0.0, 1.0) : vec3(q, 1.0);

    vec3 across = p[1] - p[0], along = p[2] - p[0], from = origin - p[0];
    vec3 face = cross(across, along);
    vec3 turned = cross(from, direction);
    float facing = -dot(face, direction);
    vec2 at = vec2(dot(turned, along), -dot(turned, across)) / facing;
    at = facing == 0.0 ? vec2(0.0) : clamp(at, 0.0, 1.0);
    at /= max(1.0, at.x + at.y);

    float z = p[0].z + at.x * across.z + at.y * along.z;
    vec3 flat_normal = (facing < 0.0 ? -1.0 : 1.0) * normalize(face);
    vec3 normal = (1.0 - at.x - at.y) * n[0] + at.x * n[1] + at.y * n[2];
    float length_squared = dot(normal, normal);
    normal = length_squared > 0.0 ? normal * inversesqrt(length_squared) : flat_normal;
    if (dot(normal, flat_normal) < 0.0)
        normal = -normal;
    if (dot(normal, direction) >= 0.0)
        normal = flat_normal;
    out_surface = vec4(normal, z);
    out_distance = z;
}
