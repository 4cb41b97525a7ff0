#version 330 core
#include "model_shape.glsl"
#include "model_values.glsl"

// split_surface.vert: the model's triangles, each with corners of its own: a vertex has other places
// in a map on each side of a chart's border. gl_VertexID counts corners, three a triangle.
//
// Drawn by   viewer/split_surface.cpp
// Reads      model_shape.glsl, model_values.glsl
//            u_wedge_normals    RGBA32F, one texel per wedge: normal.xyz 0
//            u_extra_vertices   R32UI: Surface::extra_vertices
//            u_vertex_count     so many wedges are the vertices' own
//            u_view_projection  unit frame to clip space
//            u_first_corner     of what is drawn, by u_corners
//            u_corners          R32UI, one texel per corner: its wedge
//            u_places           RG32F, u_place_count texels per corner: u v
//            u_place_count      0 without a map; 1; 3 pages that are blended
//            u_base_places      RG32F, one texel per corner: u v of the base colour
// Writes     v_normal_level  normal of the wedge, level of the vertex
//            v_own v_reference: the texels of the vertex
//            v_place v_base_place: u v
//            v_edges            from each edge of the triangle: 0 on it, 1 at the corner across
//            v_triangle         in the order of u_corners

uniform samplerBuffer u_wedge_normals;
uniform usamplerBuffer u_extra_vertices;
uniform int u_vertex_count;
uniform mat4 u_view_projection;
uniform int u_first_corner;
uniform usamplerBuffer u_corners;
uniform samplerBuffer u_places;
uniform int u_place_count;
uniform samplerBuffer u_base_places;

out vec4 v_normal_level;
out vec4 v_own;
out vec4 v_reference;
out vec2 v_place[3];
out vec2 v_base_place;
out vec3 v_edges;
flat out int v_triangle;

void main()
{
    int corner = u_first_corner + gl_VertexID;
    int wedge = int(texelFetch(u_corners, corner).r);
    int vertex = wedge;
    if (wedge >= u_vertex_count)
        vertex = int(texelFetch(u_extra_vertices, wedge - u_vertex_count).r);
    v_normal_level = vec4(texelFetch(u_wedge_normals, wedge).xyz,
                          texelFetch(u_surfels, vertex).w);
    v_own = texelFetch(u_occlusion, vertex);
    v_reference = texelFetch(u_reference, vertex);
    for (int k = 0; k < 3; ++k)
        v_place[k] = k < u_place_count
                         ? texelFetch(u_places, corner * u_place_count + k).rg
                         : vec2(0.0);
    v_base_place = texelFetch(u_base_places, corner).rg;
    v_edges = vec3(equal(ivec3(corner % 3), ivec3(0, 1, 2)));
    v_triangle = corner / 3;
    gl_Position = u_view_projection * vec4(texelFetch(u_positions, vertex).xyz, 1.0);
}
