#version 330 core
#include "model_shape.glsl"
#include "model_values.glsl"

// surface.vert: the model's triangles, indexed: gl_VertexID is the wedge (surfels/surface.h), so
// that a vertex on a hard edge has the normal of the side that is drawn.
//
// Drawn by   viewer/renderer.cpp
// Reads      model_shape.glsl, model_values.glsl
//            u_wedge_normals    RGBA32F, one texel per wedge: normal.xyz 0
//            u_extra_vertices   R32UI: Surface::extra_vertices
//            u_vertex_count     so many wedges are the vertices' own
//            u_view_projection  unit frame to clip space
// Writes     v_normal_level  normal of the wedge, level of the vertex
//            v_own v_reference: the texels of the vertex

uniform samplerBuffer u_wedge_normals;
uniform usamplerBuffer u_extra_vertices;
uniform int u_vertex_count;
uniform mat4 u_view_projection;

out vec4 v_normal_level;
out vec4 v_own;
out vec4 v_reference;

void main()
{
    int vertex = gl_VertexID;
    if (vertex >= u_vertex_count)
        vertex = int(texelFetch(u_extra_vertices, vertex - u_vertex_count).r);
    v_normal_level = vec4(texelFetch(u_wedge_normals, gl_VertexID).xyz,
                          texelFetch(u_surfels, vertex).w);
    v_own = texelFetch(u_occlusion, vertex);
    v_reference = texelFetch(u_reference, vertex);
    gl_Position = u_view_projection * vec4(texelFetch(u_positions, vertex).xyz, 1.0);
}
