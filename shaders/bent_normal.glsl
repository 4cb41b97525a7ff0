// bent_normal.glsl: twin of bent_normal_of in surfels/occlusion.cpp.
vec3 bent_normal_of(vec3 open, vec3 normal)
{
    float size = length(open);
    open -= min(0.0, dot(open, normal)) * normal;
    float left = length(open);
    return left > 0.01 * size ? open / left : normal;
}
