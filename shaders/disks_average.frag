#version 330 core
#include "disk_record.glsl"
#include "rows.glsl"
// disks_average.frag: visibility for all records, ready for the next gather: a surfel's own, a node's
// mean over its surfels by area.
//
// Vertices   fullscreen.vert, over rows of records (rows.glsl)
// Drawn by   gpu/gpu_disks.cpp, once per side
// Reads      u_far           out_far of disks_fit.frag
//            u_chunks        out_front or out_back of disks_average_chunks.frag
//            u_records       (disk_record.glsl)
//            u_record_count
// Writes     out_far         RGBA32F: FarVisibility
// CPU twin   average_over_nodes in tree/disks/disks.cpp
uniform sampler2D u_far;
uniform sampler2D u_chunks;
uniform usamplerBuffer u_records;
uniform int u_record_count;

out vec4 out_far;

void main()
{
    ivec2 texel  = ivec2(gl_FragCoord.xy);
    int   record = index_of_texel(texel);
    out_far      = texelFetch(u_far, texel, 0);
    if (record >= u_record_count || fetch_ball(u_records, record).w < 0.0)
        return;
    uvec4 links = fetch_links(u_records, record);
    vec4  sum   = vec4(0.0);
    for (int chunk = int(links.z); chunk < int(links.z + links.w); ++chunk)
        sum += texelFetch(u_chunks, texel_of_index(chunk), 0);
    out_far = sum / uintBitsToFloat(links.y);
}
