#version 330 core
// grid_box.vert: the box of an AO grid.
//
// Drawn by   pixels/grid_pass.cpp, 36 vertices without attributes, of which the back faces remain:
//            they cover each pixel of the box once, the eye inside of it or not
// Reads      u_from_box  half boxes to view space
//            u_lens_low u_lens_high u_is_orthographic  Lens
//            u_across         a pixel's middle (x, y, 1) to half boxes at distance 1 forward, as
//                             seen from the eye; orthographic: at distance 0
//            u_rest           the eye in half boxes; orthographic: what a distance of 1 adds
//            u_to_grid        directions of view space to those of the grid
//            u_inner          AoGrid: a
//            u_far u_bend     half boxes to half textures: u_far x + u_bend (x cut to [-a, a])
// Writes     gl_Position  the depth is the middle's: nothing of it is cut near or far
//            v_...        what pixels need, as it is: in software a pixel's uniform takes longer
//                         than what is computed of it. 36 of them, a box over the picture: 26 ms
//                         of the processor against 20

uniform mat4 u_from_box;
uniform vec2 u_lens_low;
uniform vec2 u_lens_high;
uniform int u_is_orthographic;
uniform mat3 u_across;
uniform vec3 u_rest;
uniform mat3 u_to_grid;
uniform vec3 u_inner;
uniform vec3 u_far;
uniform vec3 u_bend;

flat out mat3 v_across;
flat out vec3 v_rest;
flat out mat3 v_to_grid;
flat out vec3 v_inner;
flat out vec3 v_far;
flat out vec3 v_bend;

const vec2 kQuad[4] = vec2[4](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1));
const int kHalves[6] = int[6](0, 1, 2, 0, 2, 3);

void main()
{
    v_across = u_across;
    v_rest = u_rest;
    v_to_grid = u_to_grid;
    v_inner = u_inner;
    v_far = u_far;
    v_bend = u_bend;
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
