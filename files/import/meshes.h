/// meshes.h: the triangles, lines and points of assimp's meshes as primitives of glTF.
#pragma once

struct aiMesh;
namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace surfelao {

/// With all attributes but joints; texture coordinates run down as glTF's do. What it needs stands
/// in the model's buffer then. Faces of another number of corners than the first are left out
/// (aiProcess_SortByPType leaves none).
[[nodiscard]] tinygltf::Primitive add_primitive(const aiMesh& mesh, tinygltf::Model& model);

/// JOINTS_0 and WEIGHTS_0: of each vertex the four heaviest of the mesh's bones, whose numbers the
/// joints are. Weights sum up to 1, or to 0 where a vertex has none.
void add_joints(const aiMesh& mesh, tinygltf::Primitive& primitive, tinygltf::Model& model);

}  // namespace surfelao
