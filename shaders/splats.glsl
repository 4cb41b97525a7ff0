// splats.glsl: surfels as squares of two triangles, six vertices each, without attributes.
//
// Squares instead of gl_PointSize: points end at 255 pixels or wherever the driver likes.
//   u_splats        R32UI: the vertex of each splat
//   u_radii         R32F: its radius, unit frame
//   u_radius_scale  factor on the radius
//   u_view          unit frame to view space
//   u_projection    view to clip space
uniform usamplerBuffer u_splats;
uniform samplerBuffer u_radii;
uniform float u_radius_scale;
uniform mat4 u_view;
uniform mat4 u_projection;

const vec2 kCorners[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(-1, 1),
                                 vec2(-1, 1), vec2(1, -1), vec2(1, 1));

int splat_index() { return gl_VertexID / 6; }
vec2 splat_corner() { return kCorners[gl_VertexID - 6 * splat_index()]; }
int splat_vertex() { return int(texelFetch(u_splats, splat_index()).r); }
float splat_radius() { return u_radius_scale * texelFetch(u_radii, splat_index()).r; }

// A corner of the square in the surfel's own plane, in view space. Its rasterisation is the
// perspective-correct intersection of every pixel's ray with the disk, with the exact depth.
vec3 disk_corner(vec3 position, vec3 normal)
{
    // any right angle to the normal: cross with an axis that it does not lean to
    vec3 axis = abs(normal.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    vec3 tangent = normalize(cross(axis, normal));
    vec2 corner = splat_radius() * splat_corner();
    vec3 place = position + corner.x * tangent + corner.y * cross(normal, tangent);
    return (u_view * vec4(place, 1.0)).xyz;
}
