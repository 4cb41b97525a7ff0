#version 330 core
// g_triangles.frag: 1 + the number of the nearest triangle.
//
// Vertices   g_triangles.vert
// Writes     out_triangle  R32UI; cleared to 0
//            gl_FragDepth  linear in the distance forward

in float v_distance;
out uint out_triangle;

void main()
{
    out_triangle = uint(gl_PrimitiveID) + 1u;
    gl_FragDepth = v_distance;
}
