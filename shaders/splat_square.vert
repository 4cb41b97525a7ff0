#version 330 core
#include "model_shape.glsl"
#include "model_values.glsl"
#include "splats.glsl"
#include "splat_paint.glsl"

// splat_square.vert: a splat as a square that faces the camera, at the splat's depth.
//
// Its side on the screen is R * h * cot(fovy / 2) / depth pixels, R being the radius and h the
// picture's height: the projection of a square of side 2R at that depth, for any field of view.
//
// Drawn by   viewer/renderer.cpp, 6 vertices per splat
// Reads      model_shape.glsl, model_values.glsl, splats.glsl, splat_paint.glsl
// Writes     v_disk          place on the square, -1..1 in both directions
//            v_view_normal   the disk's normal in view space
//            v_center_depth  its z in view space
//            v_radius        its radius
//            v_normal_level  the disk's normal and level; v_own v_reference v_paint: the
//                    values there

out vec2 v_disk;
flat out vec3 v_view_normal;
flat out float v_center_depth;
flat out float v_radius;
flat out vec4 v_normal_level;
flat out vec4 v_own;
flat out vec4 v_reference;
flat out vec3 v_paint;

void main()
{
    Splat splat = this_splat();
    v_disk = splat_corner();
    v_normal_level = vec4(splat_normal(splat), value_at(splat, u_surfels).w);
    v_own = value_at(splat, u_occlusion);
    v_reference = value_at(splat, u_reference);
    v_paint = splat_paint(splat);
    v_radius = splat_radius();
    v_view_normal = mat3(u_view) * splat_normal(splat);
    vec3 view = (u_view * vec4(value_at(splat, u_positions).xyz, 1.0)).xyz;
    v_center_depth = view.z;
    view.xy += v_radius * v_disk;
    gl_Position = u_projection * vec4(view, 1.0);
}
