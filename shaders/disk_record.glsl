// disk_record.glsl: the octree of tree/disks/octree.h as one array of records, nodes and surfels alike.
//
// Preorder, with each leaf's surfels right behind it, so that "open" means "go on to the next record"
// for every node, and one piece of code adds nodes and surfels. Three RGBA32UI texels, since a float
// fetch may flush a small integer (a denormal) to zero:
//   0  center.xyz  radius       (radius -1 - reach: a surfel; its triangle's, or 0)
//   1  normal.xyz  flat_area    (flat_area = area for a surfel)
//   2  next        area         first_chunk  chunk_count   (the last two: disks_average.frag; of a
//                                                      surfel: 1 + its triangle, or 0; 0)
//
// Host side  gpu/gpu_disks.cpp makes the records
vec4 fetch_ball(usamplerBuffer records, int record)
{
    return uintBitsToFloat(texelFetch(records, record * 3));
}

vec4 fetch_normal_and_flat_area(usamplerBuffer records, int record)
{
    return uintBitsToFloat(texelFetch(records, record * 3 + 1));
}

uvec4 fetch_links(usamplerBuffer records, int record)
{
    return texelFetch(records, record * 3 + 2);
}
