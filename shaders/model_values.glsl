// model_values.glsl: what was found out about a model's vertices, as viewer/renderer.cpp uploads it.
//   u_occlusion  RGBA32F, one texel per vertex: bent normal.xyz, occlusion (surfels/occlusion.h)
//   u_reference  the same by rays
uniform samplerBuffer u_occlusion;
uniform samplerBuffer u_reference;
