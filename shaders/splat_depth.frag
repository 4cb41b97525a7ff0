#version 330 core

// splat_depth.frag: the depth of a surfel's disk, nothing else.
//
// Vertices   splat_depth.vert
// Writes     depth

in vec2 v_disk;
in vec3 v_inside;

void main()
{
    if (dot(v_disk, v_disk) > 1.0 || any(lessThan(v_inside, vec3(0.0))))
        discard;
}
