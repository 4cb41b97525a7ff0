// pixel_ray.glsl: where a pixel of a G-buffer lies in view space: x right, y up, z forward.
//
// Host side  gpu/g_buffer.h, pixel_ray()
//   u_lens_low u_lens_high  Lens
//   u_is_orthographic       0 or 1
//   u_size                  of the picture, in pixels
uniform vec2 u_lens_low;
uniform vec2 u_lens_high;
uniform int u_is_orthographic;
uniform ivec2 u_size;

// place: pixels from the lower left corner; a pixel's middle is at + 1/2
vec2 lens_place(vec2 place) { return mix(u_lens_low, u_lens_high, place / vec2(u_size)); }

// of what lies there at the distance z forward
vec3 view_position(vec2 place, float z)
{
    vec2 q = lens_place(place);
    return vec3(u_is_orthographic == 1 ? q : z * q, z);
}

// towards the eye, unit length
vec3 to_eye(vec3 position)
{
    return u_is_orthographic == 1 ? vec3(0.0, 0.0, -1.0) : -normalize(position);
}

// where a point of view space is seen, in pixels
vec2 place_of(vec3 position)
{
    vec2 q = u_is_orthographic == 1 ? position.xy : position.xy / position.z;
    return (q - u_lens_low) / (u_lens_high - u_lens_low) * vec2(u_size);
}

// pixels a unit of length at the distance z
float pixels_per_unit(float z)
{
    float scale = float(u_size.y) / (u_lens_high.y - u_lens_low.y);
    return u_is_orthographic == 1 ? scale : scale / z;
}
