// triangle_moment.glsl: what a triangle covers of a receiver's hemisphere, and in which direction.
//
// CPU twin   moment_of_triangle in tree/disks/gather.cpp; formulas and sources: tree/disks/form_factor.h
const float kLeastSine2 = 1e-14;
const float kLeastLength2 = 1e-16;

vec3 unit_or_zero(vec3 a) { return a * inversesqrt(max(dot(a, a), kLeastLength2)); }

vec3 moment_of_arc(vec3 a, vec3 b)
{
    float x      = dot(a, b);
    float y      = abs(x);
    float acute  = (0.8543985 + (0.4965155 + 0.0145206 * y) * y) / (3.4175940 + (4.1616724 + y) * y);
    vec3  across = cross(a, b);
    float obtuse = 0.5 * inversesqrt(max(dot(across, across), kLeastSine2)) - acute;
    return across * (x > 0.0 ? acute : obtuse);
}

// c: from the receiver to its centroid; a, b: from there to two corners.
vec3 moment_of_triangle(vec3 c, vec3 a, vec3 b, vec3 normal)
{
    vec3 corners[3] = vec3[3](unit_or_zero(c + a), unit_or_zero(c + b), unit_or_zero(c - a - b));
    vec3 moment  = vec3(0.0);
    vec3 leaves  = vec3(0.0);
    vec3 returns = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        vec3  from    = corners[i];
        vec3  to      = corners[(i + 1) % 3];
        float at_from = dot(from, normal);
        float at_to   = dot(to, normal);
        vec3  horizon = unit_or_zero(from * abs(at_to) + to * abs(at_from));
        if (at_from > 0.0 || at_to > 0.0)
            moment += moment_of_arc(at_from > 0.0 ? from : horizon, at_to > 0.0 ? to : horizon);
        if (at_from > 0.0 && at_to <= 0.0)
            leaves = horizon;
        if (at_from <= 0.0 && at_to > 0.0)
            returns = horizon;
    }
    return moment + moment_of_arc(leaves, returns);
}
