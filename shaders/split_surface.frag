#version 330 core
#include "shading.glsl"
#include "pixel_values.glsl"

// split_surface.frag: a triangle's pixel, with the values of a map, a base colour, and its edges.
//
// Vertices   split_surface.vert
// Reads      shading.glsl, pixel_values.glsl
//            u_place_count      0: the values are the vertices'
//            u_facts            RGBA32UI, u_place_count texels per triangle: 1 + page, 0 where the
//                               triangle is not in the map; colour of the chart, 0xBBGGRR as shown;
//                               density as a float's bits, 1 = hottest; 0
//            u_map u_map_reference  RGBA8, page by page, row by row: bent normal (n + 1) / 2,
//                               visibility
//            u_map_size         of a page
//            u_base             the base colour's texture
//            u_base_factor      linear
//            u_wireframe        1: lines along the triangle's edges lie over what it shows
// Writes     out_color          linear, opaque
//
// Based on, for the lines:
//   Baerentzen, Munk-Lund, Gjoel, Larsen. Two Methods for Antialiased Wireframe Drawing with Hidden
//   Line Removal. 2008

uniform int u_place_count;
uniform usamplerBuffer u_facts;
uniform samplerBuffer u_map;
uniform samplerBuffer u_map_reference;
uniform ivec2 u_map_size;
uniform sampler2D u_base;
uniform vec3 u_base_factor;
uniform int u_wireframe;

in vec4 v_normal_level;
in vec4 v_own;
in vec4 v_reference;
in vec2 v_place[3];
in vec2 v_base_place;
in vec3 v_edges;
flat in int v_triangle;
out vec4 out_color;

const int kCharts = 7;
const int kDensity = 8;
const int kTextured = 9;

const vec3 kNoPlace = vec3(0.05);  // what is not in the map
const float kDimmest = 0.25;       // light that charts keep where nothing is visible

const float kLineWidth = 1.25;                // of the wireframe, pixels
const vec3 kLine = vec3(0.02, 0.15, 0.6);  // told from all greys, light and dark

// Twin of fetch in image/map.h: linear between the four texels around, repeating.
vec4 fetch_map(samplerBuffer map, int page, vec2 uv)
{
    vec2 place = fract(uv) * vec2(u_map_size) - 0.5;
    vec2 low = floor(place);
    vec2 share = place - low;
    ivec2 a = (ivec2(low) + u_map_size) % u_map_size;
    ivec2 b = (a + 1) % u_map_size;
    int first = page * u_map_size.x * u_map_size.y;
    int row_a = first + a.y * u_map_size.x, row_b = first + b.y * u_map_size.x;
    return mix(mix(texelFetch(map, row_a + a.x), texelFetch(map, row_a + b.x), share.x),
               mix(texelFetch(map, row_b + a.x), texelFetch(map, row_b + b.x), share.x), share.y);
}

// From a map's numbers to those of model_values.glsl.
vec4 occlusion_of(vec4 texel)
{
    return vec4(2.0 * texel.xyz - 1.0, 1.0 - texel.w);
}

// Twins of atlas/layout.cpp. Pages without a weight count where there are no others.
const float kLeastPageWeight = 0.25;
const float kNoWeight = 1e-12;

// The values at this pixel, and what is told of its places: the mean over them.
struct MapValues {
    vec4 own, reference;
    vec3 chart;
    float density;
    bool is_there;
};
MapValues map_values()
{
    MapValues sum = MapValues(vec4(0.0), vec4(0.0), vec3(0.0), 0.0, false);
    float weights = 0.0;
    vec3 normal = safe_normalize(v_normal_level.xyz);
    vec3 squares = normal * normal;
    for (int k = 0; k < u_place_count; ++k) {
        uvec4 facts = texelFetch(u_facts, v_triangle * u_place_count + k);
        if (facts.x == 0u)
            continue;
        float weight = 1.0;
        if (u_place_count > 1)
            weight = max(squares[k] - kLeastPageWeight, kNoWeight);
        int page = int(facts.x) - 1;
        sum.own += weight * fetch_map(u_map, page, v_place[k]);
        sum.reference += weight * fetch_map(u_map_reference, page, v_place[k]);
        sum.chart += weight * vec3(uvec3(facts.y, facts.y >> 8, facts.y >> 16) & 255u) / 255.0;
        sum.density += weight * uintBitsToFloat(facts.z);
        sum.is_there = true;
        weights += weight;
    }
    if (!sum.is_there)
        return sum;
    sum.own = occlusion_of(sum.own / weights);
    sum.reference = occlusion_of(sum.reference / weights);
    sum.chart = srgb_decode(sum.chart / weights);
    sum.density /= weights;
    return sum;
}

vec3 color()
{
    vec4 own = v_own;
    vec4 reference = v_reference;
    read_pixels(own, reference, v_normal_level.xyz);
    if (is_hole(u_colors))
        return kHole;
    if (u_place_count > 0 && u_has_pixels == 0) {
        MapValues values = map_values();
        if (!values.is_there)
            return kNoPlace;
        own = values.own;
        reference = values.reference;
        if (u_colors == kCharts)
            return values.chart * mix(1.0 - own.w, 1.0, kDimmest);
        if (u_colors == kDensity)
            return map_color(values.density);
    }
    if (u_colors == kTextured)
        return u_base_factor * texture(u_base, v_base_place).rgb * (1.0 - at_wipe(own, reference).w);
    return shade(v_normal_level, own, reference);
}

// The share of the pixel that lines about the edges cover. Each side of an edge draws half of one.
float line_share()
{
    vec3 right = dFdx(v_edges), up = dFdy(v_edges);
    vec3 away = v_edges / max(sqrt(right * right + up * up), 1e-9);  // pixels
    float nearest = min(away.x, min(away.y, away.z));
    return clamp(0.5 * kLineWidth + 0.5 - nearest, 0.0, 1.0);
}

void main()
{
    float line = u_wireframe == 1 ? line_share() : 0.0;
    out_color = vec4(mix(color(), kLine, line), 1.0);
}
