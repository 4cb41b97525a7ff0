#version 330 core

// ground.vert: the square under the model, as two triangles.
//
// Drawn by   viewer/renderer.cpp, 6 vertices
// Reads      u_corner u_axis_x u_axis_y  ShadowSquare of viewer/model.h
//            u_view_projection
// Writes     v_place  0..1 along both axes

uniform vec3 u_corner;
uniform vec3 u_axis_x;
uniform vec3 u_axis_y;
uniform mat4 u_view_projection;

out vec2 v_place;

const vec2 kCorners[6] =
    vec2[6](vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1));

void main()
{
    v_place = kCorners[gl_VertexID];
    vec3 position = u_corner + v_place.x * u_axis_x + v_place.y * u_axis_y;
    gl_Position = u_view_projection * vec4(position, 1.0);
}
