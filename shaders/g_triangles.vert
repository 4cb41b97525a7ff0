#version 330 core
// g_triangles.vert: the triangles as they are seen, by their numbers alone.
//
// Drawn by   gpu/g_buffer.cpp, indexed by Geometry::triangles
// Reads      u_positions        RGBA32F, one texel per vertex: position.xyz 0
//            u_eye u_right u_up u_forward  View
//            u_lens_low u_lens_high u_is_orthographic  Lens
//            u_near u_far       distances forward, 0 < near < far
// Writes     v_distance         forward, 0 at the eye, 1 at u_far

uniform samplerBuffer u_positions;
uniform vec3 u_eye;
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec3 u_forward;
uniform vec2 u_lens_low;
uniform vec2 u_lens_high;
uniform int u_is_orthographic;
uniform float u_near;
uniform float u_far;

out float v_distance;

void main()
{
    vec3 d = texelFetch(u_positions, gl_VertexID).xyz - u_eye;
    vec3 p = vec3(dot(d, u_right), dot(d, u_up), dot(d, u_forward));
    float w = u_is_orthographic == 1 ? 1.0 : p.z;
    vec2 clip = (2.0 * p.xy - w * (u_lens_low + u_lens_high)) / (u_lens_high - u_lens_low);
    // only cuts off what lies before u_near or behind u_far: depth comes from v_distance
    float depth = u_is_orthographic == 1
                      ? (2.0 * p.z - u_near - u_far) / (u_far - u_near)
                      : ((u_far + u_near) * p.z - 2.0 * u_far * u_near) / (u_far - u_near);
    v_distance = p.z / u_far;
    gl_Position = vec4(clip, depth, w);
}
