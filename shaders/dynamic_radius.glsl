#include "screen_space.glsl"

// dynamic_radius.glsl: a radius from 0 to R that goes by what the picture shows within R of the
// pixel: shadows in grooves that R is too wide for. "Nearest" is nearest to the eye, of the probes
// that see something.
//
//   rule  radius
//   1     (z - z_nearest) / z_nearest R
//   2     the same with the mean distance of those that are nearer than z
//   3     the same with the root of the mean of (z_probe - z)^2
//   4     as 1 where z - z_nearest is below the limit; R elsewhere
//   5     to the nearest of those that are nearer than z by less than the limit
//   6     to the last of those that, from the rim inwards, are each nearer than z and than those
//         before them, and closer to the pixel's point: the next summit
//   Where a rule finds nothing nearer than the pixel's point: 0.
//
// Based on   Vocilka. Comparison of screen-space ambient occlusion methods. Bachelor thesis, 2013
// Departs    its signs are loose: here what is nearer to the eye makes a groove; rules are clamped
//            to [0, R]; its probes are a Poisson disk, ours a sunflower from the rim inwards
//
// Host side  gpu/screen_space.h
//   u_rule         0: R; 1 to 6
//   u_probes       RG32F: offsets in the unit disk, from the rim inwards
//   u_probe_count
//   u_depth_limit  in units of view space
uniform int u_rule;
uniform samplerBuffer u_probes;
uniform int u_probe_count;
uniform float u_depth_limit;

float chosen_radius(vec3 position)
{
    if (u_rule == 0)
        return u_radius;
    vec2 pixels = u_radius * pixels_at(position.z);
    float nearest = position.z, square_sum = 0.0, nearer_sum = 0.0;
    float count = 0.0, nearer_count = 0.0;
    float found = u_radius, found_z = position.z;
    bool is_found = false;
    for (int i = 0; i < u_probe_count; ++i) {
        ivec2 pixel =
            ivec2(floor(gl_FragCoord.xy + texelFetch(u_probes, i).xy * pixels));
        if (is_outside(pixel))
            continue;
        float z = distance_at(pixel);
        if (z >= kNothingThere)
            continue;
        float nearer = position.z - z;
        count += 1.0;
        square_sum += nearer * nearer;
        nearest = min(nearest, z);
        nearer_count += nearer > 0.0 ? 1.0 : 0.0;
        nearer_sum += nearer > 0.0 ? z : 0.0;
        float away = distance(position, view_position(vec2(pixel) + 0.5, z));
        bool is_taken = z < found_z &&
                        (u_rule == 5 ? nearer < u_depth_limit : away < found);
        found_z = is_taken ? z : found_z;
        found = is_taken ? away : found;
        is_found = is_found || is_taken;
    }
    if (u_rule >= 5)
        return is_found ? min(found, u_radius) : 0.0;
    float z = nearest;
    if (u_rule == 2)
        z = nearer_count > 0.0 ? nearer_sum / nearer_count : position.z;
    if (u_rule == 3)
        z = count > 0.0 ? sqrt(square_sum / count) : position.z;
    if (u_rule == 4 && position.z - nearest >= u_depth_limit)
        return u_radius;
    return u_radius * clamp((position.z - z) / max(z, 1e-20), 0.0, 1.0);
}
