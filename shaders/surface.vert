#version 330 core
#include "model_shape.glsl"
#include "model_values.glsl"

// surface.vert: the model's triangles, indexed: gl_VertexID is the vertex.
//
// Drawn by   viewer/renderer.cpp
// Reads      model_shape.glsl, model_values.glsl
//            u_view_projection  unit frame to clip space
// Writes     v_normal_level v_own v_reference: the texels of the vertex

uniform mat4 u_view_projection;

out vec4 v_normal_level;
out vec4 v_own;
out vec4 v_reference;

void main()
{
    v_normal_level = texelFetch(u_normals, gl_VertexID);
    v_own = texelFetch(u_occlusion, gl_VertexID);
    v_reference = texelFetch(u_reference, gl_VertexID);
    gl_Position = u_view_projection * vec4(texelFetch(u_positions, gl_VertexID).xyz, 1.0);
}
