// model_shape.glsl: where a model's vertices are, as viewer/renderer.cpp uploads them.
//   u_positions  RGBA32F, one texel per vertex: position.xyz (unit frame) 0
//   u_surfels    RGBA32F, one texel per vertex: the surfel's normal.xyz, level of its leaf in the
//                octree (0 = highest leaf, 1 = deepest)
uniform samplerBuffer u_positions;
uniform samplerBuffer u_surfels;
