#version 330 core
// grid_box.vert: the box of an AO grid.
//
// Drawn by   pixels/grid_pass.cpp, 36 vertices without attributes, of which the back faces remain:
//            they cover each pixel of the box once, the eye inside of it or not
// Reads      u_from_box  half boxes to view space
//            u_lens_low u_lens_high u_is_orthographic  Lens
// Writes     gl_Position alone; the depth is the middle's: nothing of it is cut near or far

uniform mat4 u_from_box;
uniform vec2 u_lens_low;
uniform vec2 u_lens_high;
uniform int u_is_orthographic;

const vec2 kQuad[4] = vec2[4](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1));
const int kHalves[6] = int[6](0, 1, 2, 0, 2, 3);

void main()
{
    int face = gl_VertexID / 6;
    int axis = face >> 1;
    bool is_high = (face & 1) == 1;
    vec2 q = kQuad[kHalves[gl_VertexID % 6]];
    vec3 corner;
    corner[axis] = is_high ? 1.0 : -1.0;
    corner[(axis + 1) % 3] = is_high ? q.x : q.y;
    corner[(axis + 2) % 3] = is_high ? q.y : q.x;
    vec3 p = (u_from_box * vec4(corner, 1.0)).xyz;
    float w = u_is_orthographic == 1 ? 1.0 : p.z;
    gl_Position =
        vec4((2.0 * p.xy - w * (u_lens_low + u_lens_high)) / (u_lens_high - u_lens_low), 0.0, w);
}
