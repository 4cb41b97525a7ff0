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

// Taken once a pixel: in software a uniform takes longer than what is computed of it, in a loop
// each time.
vec2 lens_low = u_lens_low;
vec2 lens_step = (u_lens_high - u_lens_low) / vec2(u_size);  // of a pixel
bool is_orthographic = u_is_orthographic == 1;
ivec2 picture_size = u_size;

// place: pixels from the lower left corner; a pixel's middle is at + 1/2
vec2 lens_place(vec2 place) { return lens_low + lens_step * place; }

// of what lies there at the distance z forward
vec3 view_position(vec2 place, float z)
{
    vec2 q = lens_place(place);
    return vec3(is_orthographic ? q : z * q, z);
}

// towards the eye, unit length
vec3 to_eye(vec3 position) { return is_orthographic ? vec3(0.0, 0.0, -1.0) : -normalize(position); }

// where a point of view space is seen, in pixels
vec2 place_of(vec3 position)
{
    vec2 q = is_orthographic ? position.xy : position.xy / position.z;
    return (q - lens_low) / lens_step;
}

// pixels a unit of length at the distance z
float pixels_per_unit(float z)
{
    float scale = 1.0 / lens_step.y;
    return is_orthographic ? scale : scale / z;
}
