/// gltf_pose.h: the vertices of a glTF mesh as its default pose has them: morphed, skinned, placed.
/// Internal to the glTF reader.
#pragma once

#include "files/gltf_mesh.h"
#include "files/gltf_nodes.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// The vertices of a group, in mesh space.
struct MeshVertices {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;   ///< as stored, of any length, finite or not; may be empty
    std::vector<glm::dvec4> tangents;  ///< likewise
    std::vector<std::size_t> lost;     ///< whose positions were not finite, in no triangle
    std::size_t stand_in = 0;          ///< where there are such: the vertex that they stand on
};

/// The stored vertices plus the displacements of the targets times their weights; targets beyond
/// the weights have none. A vertex whose values are not finite and which no triangle of the group
/// has stands where the first that has one stands; others make it throw InputError. O(vertices *
/// targets of a weight that is not 0).
[[nodiscard]] MeshVertices read_vertices(const Group& group, std::span<const double> weights,
                                         const AccessorResolver& resolver);

/// What one morph target adds at a weight of 1, in mesh space; empty where it adds nothing.
struct Displacements {
    std::vector<glm::dvec3> positions;  ///< zero where they are not finite, in no triangle
    std::vector<glm::dvec3> normals;
};

/// Of all targets of the group. Throws InputError as read_vertices(). O(vertices * targets).
[[nodiscard]] std::vector<Displacements> read_displacements(const Group& group,
                                                            const AccessorResolver& resolver);

/// Adds them, times a weight.
void add_scaled(std::vector<glm::dvec3>& sums, const std::vector<glm::dvec3>& vectors,
                double weight);

/// The matrices that take a skin's joints from the mesh as it was bound to the world: the joint's
/// own times its inverse bind matrix (without: the identity). Throws InputError. O(joints).
[[nodiscard]] std::vector<glm::dmat4> joint_matrices(const tinygltf::Model& model, std::size_t skin,
                                                     std::span<const glm::dmat4> world,
                                                     const AccessorResolver& resolver);

/// The joints that a vertex follows. Weights are positive; where the file has none such the vertex
/// follows its first joint, as in viewers (three.js).
struct Influences {
    struct Influence {
        std::uint32_t joint = 0;
        double weight = 1.0;
    };
    std::vector<std::size_t> first;  ///< per vertex, into `all`; and where the last one ends
    std::vector<Influence> all;
};

/// Throws InputError naming a joint that the skin does not have. O(vertices * sets).
[[nodiscard]] Influences read_influences(const Group& group, std::size_t joint_count,
                                         const AccessorResolver& resolver);

/// Per vertex, the mean of the joints' matrices by weight; weights need not sum up to 1. O(all).
[[nodiscard]] std::vector<glm::dmat4> vertex_matrices(const Influences& influences,
                                                      std::span<const glm::dmat4> joints);

/// Brings normals from mesh space into the world: along the inverse transpose of the linear part,
/// so that they stay upright under uneven scales and on the outside under mirrors.
class NormalMatrix {
public:
    explicit NormalMatrix(const glm::dmat3& to_world);

    /// At unit length; zero where there is no direction.
    [[nodiscard]] glm::vec3 operator()(const glm::dvec3& normal) const;

private:
    glm::dmat3 matrix_;
};

/// A tangent of mesh space in the world, as Scene has it: along the matrix itself, of unit length;
/// a mirror turns the sign. Zero where there is no direction.
[[nodiscard]] glm::vec4 tangent_in_world(const glm::dmat3& to_world, const glm::dvec4& tangent);

/// The matrix times a positive number, so that its largest entry is 1: for directions, which must
/// neither underflow nor overflow. Zero stays zero.
[[nodiscard]] glm::dmat3 scaled_to_one(const glm::dmat3& matrix);

}  // namespace surfelao
