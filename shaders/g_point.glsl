#include "pixel_ray.glsl"

// g_point.glsl: where the ray through a pixel's middle meets the triangle that is seen there.
//
// Host side  gpu/g_buffer.h
//   u_seen       R32UI: 1 + triangle, 0 where there is none
//   u_positions  RGBA32F, one texel per vertex: position.xyz 0
//   u_triangles  R32UI, three texels per triangle: its vertices
//   u_eye u_right u_up u_forward  View
uniform usampler2D u_seen;
uniform samplerBuffer u_positions;
uniform usamplerBuffer u_triangles;
uniform vec3 u_eye;
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec3 u_forward;

vec3 in_view(vec3 v) { return vec3(dot(v, u_right), dot(v, u_up), dot(v, u_forward)); }

uint seen_triangle() { return texelFetch(u_seen, ivec2(gl_FragCoord.xy), 0).r; }

struct SeenPoint {
    vec2 at;         // weights of the second and third corner
    float z;         // distance forward
    vec3 direction;  // of the ray
    vec3 face;       // across the triangle, of any length
    float facing;    // above 0: the eye is in front
};

SeenPoint point_of(int triangle)
{
    vec3 p[3];
    for (int k = 0; k < 3; ++k)
        p[k] = in_view(
            texelFetch(u_positions, int(texelFetch(u_triangles, 3 * triangle + k).r)).xyz - u_eye);
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
    return SeenPoint(at, p[0].z + at.x * across.z + at.y * along.z, direction, face, facing);
}
