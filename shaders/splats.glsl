// splats.glsl: splats as squares of two triangles, six vertices each, without attributes.
//
// Squares instead of gl_PointSize: points end at 255 pixels or wherever the driver likes.
// Goes with model_shape.glsl.
//   u_splat_stride  every so many-th is drawn
//   u_splats        RGBA32UI: Splat of viewer/model.h
//   u_radii         R32F: its radius, unit frame
//   u_radius_scale  factor on the radius
//   u_view          unit frame to view space
//   u_projection    view to clip space
uniform int u_splat_stride;
uniform usamplerBuffer u_splats;
uniform samplerBuffer u_radii;
uniform float u_radius_scale;
uniform mat4 u_view;
uniform mat4 u_projection;

const vec2 kCorners[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(-1, 1),
                                 vec2(-1, 1), vec2(1, -1), vec2(1, 1));

int splat_index() { return u_splat_stride * (gl_VertexID / 6); }
vec2 splat_corner() { return kCorners[gl_VertexID % 6]; }
float splat_radius() { return u_radius_scale * texelFetch(u_radii, splat_index()).r; }

// Whose values a splat shows: three vertices and their shares.
struct Splat {
    ivec3 vertices;
    vec3 shares;
    bool is_surfel;  // else a place inside of a triangle
};

Splat this_splat()
{
    uvec4 texel = texelFetch(u_splats, splat_index());
    vec2  place = vec2(texel.w & 0xFFFFu, texel.w >> 16) / 65535.0;
    return Splat(ivec3(texel.xyz), vec3(1.0 - place.x - place.y, place), texel.x == texel.y);
}

vec4 value_at(Splat splat, samplerBuffer values)
{
    return splat.shares.x * texelFetch(values, splat.vertices.x) +
           splat.shares.y * texelFetch(values, splat.vertices.y) +
           splat.shares.z * texelFetch(values, splat.vertices.z);
}

// Of the disk: the triangle's where it lies in one.
vec3 splat_normal(Splat splat)
{
    if (splat.is_surfel)
        return texelFetch(u_surfels, splat.vertices.x).xyz;
    vec3 a = texelFetch(u_positions, splat.vertices.x).xyz;
    vec3 b = texelFetch(u_positions, splat.vertices.y).xyz;
    vec3 c = texelFetch(u_positions, splat.vertices.z).xyz;
    return normalize(cross(normalize(b - a), normalize(c - a)));
}

// How far a point of the triangle's plane is inside of each edge, in radii of the splat and a tenth
// more, so that neighbours leave no crack. Surfels have no edges.
vec3 inside_edges(Splat splat, vec3 place)
{
    if (splat.is_surfel)
        return vec3(1.0);
    vec3 corner[3] = vec3[3](texelFetch(u_positions, splat.vertices.x).xyz,
                             texelFetch(u_positions, splat.vertices.y).xyz,
                             texelFetch(u_positions, splat.vertices.z).xyz);
    vec3 normal = splat_normal(splat);
    vec3 inside;
    for (int i = 0; i < 3; ++i) {
        vec3 edge = normalize(corner[(i + 1) % 3] - corner[i]);
        inside[i] = dot(place - corner[i], cross(normal, edge)) / splat_radius() + 0.1;
    }
    return inside;
}

// A corner of the square in the disk's own plane, unit frame. Its rasterisation is the
// perspective-correct intersection of every pixel's ray with the disk, with the exact depth.
vec3 disk_corner(Splat splat)
{
    vec3 normal = splat_normal(splat);
    // any right angle to the normal: cross with an axis that it does not lean to
    vec3 axis = abs(normal.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    vec3 tangent = normalize(cross(axis, normal));
    vec2 corner = splat_radius() * splat_corner();
    return value_at(splat, u_positions).xyz + corner.x * tangent +
           corner.y * cross(normal, tangent);
}
