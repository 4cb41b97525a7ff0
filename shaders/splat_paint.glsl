// splat_paint.glsl: the colours that points have of their own. Goes with splats.glsl.
//   u_paint       RGBA32F, one texel per vertex: linear
//   u_is_painted  1: what is shown is multiplied by it
uniform samplerBuffer u_paint;
uniform int u_is_painted;

vec3 splat_paint(Splat splat)
{
    return u_is_painted == 1 ? value_at(splat, u_paint).rgb : vec3(1.0);
}
