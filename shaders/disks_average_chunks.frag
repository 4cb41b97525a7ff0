#version 330 core
#include "disk_record.glsl"
#include "rows.glsl"
// disks_average_chunks.frag: sums of the surfels' visibility over stretches of records. A node's
// subtree is a stretch, cut into chunks so that no fragment runs long.
//
// Vertices     fullscreen.vert, over rows of chunks (rows.glsl)
// Drawn by     gpu/gpu_disks.cpp
// Definitions  TWO_SIDED: 0 or 1
// Reads        u_chunks       RGBA32UI: node record, first record, end record, 0
//              u_chunk_count
//              u_records      (disk_record.glsl)
//              u_far_front    out_far of disks_fit.frag for the side of the casting normal
//              u_far_back     the same for the other side                        (TWO_SIDED)
// Writes       out_front      RGBA32F: sum of area * visibility on the node's front side: surfels that
//                             face against the node give their other side
//              out_back       the same for the node's back                       (TWO_SIDED)
// CPU twin     average_over_nodes in tree/disks/disks.cpp
#ifndef TWO_SIDED
#define TWO_SIDED 0
#endif

uniform usamplerBuffer u_chunks;
uniform int u_chunk_count;
uniform usamplerBuffer u_records;
uniform sampler2D u_far_front;
#if TWO_SIDED
uniform sampler2D u_far_back;
#endif

layout(location = 0) out vec4 out_front;
#if TWO_SIDED
layout(location = 1) out vec4 out_back;
#endif

void main()
{
    vec4 front = vec4(0.0);
    vec4 back  = vec4(0.0);
    int  index = index_of_texel(ivec2(gl_FragCoord.xy));
    if (index < u_chunk_count) {
        uvec4 chunk = texelFetch(u_chunks, index);
#if TWO_SIDED
        vec3 node_normal = fetch_normal_and_flat_area(u_records, int(chunk.x)).xyz;
#endif
        for (int record = int(chunk.y); record < int(chunk.z); ++record) {
            // nodes have no visibility of their own yet (zero), so they add nothing
            vec4  shape    = fetch_normal_and_flat_area(u_records, record);
            vec4  on_front = shape.w * texelFetch(u_far_front, texel_of_index(record), 0);
#if TWO_SIDED
            vec4 on_back = shape.w * texelFetch(u_far_back, texel_of_index(record), 0);
            bool turned  = dot(shape.xyz, node_normal) < 0.0;
            front += turned ? on_back : on_front;
            back  += turned ? on_front : on_back;
#else
            front += on_front;
#endif
        }
    }
    out_front = front;
#if TWO_SIDED
    out_back = back;
#endif
}
