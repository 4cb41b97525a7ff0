// pixel_values.glsl: values of the pixels of the picture that is drawn, in place of the model's own.
//
// Host side  viewer/pixel_values.h
//   u_has_pixels       0: there are none; 1: u_own_pixels is bent normal.xyz, occlusion; 2: it is the
//                      occlusion alone; 3: occlusion and, as green, how far that counts; 4: 1 - it
//   u_pixel_guard      u_own_pixels is so many pixels larger than the target on each side
//   u_has_pixel_rays   0: what was found stands in for the reference
//   u_own_pixels u_pixel_rays  as large as the target: what was found, and by rays
//   u_pixel_surface    GBuffer::surface(): normal, distance forward; the same size
uniform int u_has_pixels;
uniform int u_pixel_guard;
uniform int u_has_pixel_rays;
uniform sampler2D u_own_pixels;
uniform sampler2D u_pixel_rays;
uniform sampler2D u_pixel_surface;

// A sample inside a pixel may see another surface than the pixel's middle does: then the neighbour's
// value is right whose distance is most like the sample's. The pixel's own has to be off by so many
// times more.
const float kOwnIsBetter = 4.0;

ivec2 nearest_pixel()
{
    ivec2 here = ivec2(gl_FragCoord.xy);
    float forward = 1.0 / gl_FragCoord.w;
    ivec2 last = textureSize(u_pixel_surface, 0) - 1;
    ivec2 best = here;
    float least = abs(texelFetch(u_pixel_surface, here, 0).w - forward) / kOwnIsBetter;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 there = clamp(here + ivec2(x, y), ivec2(0), last);
            float off = abs(texelFetch(u_pixel_surface, there, 0).w - forward);
            if (off < least) {
                least = off;
                best = there;
            }
        }
    }
    return best;
}

// Of the last read_pixels(): less than 1 where the model's own values stand in.
float pixel_coverage = 1.0;

// A hole of cube maps where these are told of (Colors::coverage).
const int kCoverage = 10;
const vec3 kHole = vec3(1.0, 0.0, 0.0);

bool is_hole(int colors) { return colors == kCoverage && pixel_coverage == 0.0; }

// normal: of the surface, which stands for a bent normal that is not known.
void read_pixels(inout vec4 own, inout vec4 reference, vec3 normal)
{
    if (u_has_pixels == 0)
        return;
    ivec2 pixel = nearest_pixel();
    vec4 stand_in = own;
    own = texelFetch(u_own_pixels, pixel + u_pixel_guard, 0);
    if (u_has_pixels == 2)
        own = vec4(normal, own.r);
    if (u_has_pixels == 3) {
        pixel_coverage = own.g;
        own = mix(stand_in, vec4(normal, own.r), pixel_coverage);
    }
    if (u_has_pixels == 4)
        own = vec4(normal, 1.0 - own.r);
    reference = u_has_pixel_rays == 1 ? texelFetch(u_pixel_rays, pixel, 0) : own;
}
