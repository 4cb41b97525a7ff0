// model_shape.glsl: where a model's vertices are, as viewer/renderer.cpp uploads them.
//   u_positions  RGBA32F, one texel per vertex: position.xyz (unit frame) 0
//   u_normals    RGBA32F, one texel per vertex: normal.xyz, level of the surfel's leaf in the octree
//                (0 = highest leaf, 1 = deepest)
uniform samplerBuffer u_positions;
uniform samplerBuffer u_normals;
