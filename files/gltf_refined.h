/// gltf_refined.h: the meshes of a glTF with their triangles cut. Internal to refined_scene.cpp and
/// the glTF writer.
#pragma once

#include "files/gltf_added.h"
#include "files/gltf_asset.h"
#include "surfels/refinement.h"
#include "surfels/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <glm/vec3.hpp>

#include <span>
#include <string>

namespace surfelao {

/// Gives each use of a mesh one of its own, and those that are cut accessors and indices of their
/// own. normals: as in refined_scene(), for a file without NORMAL. Throws InputError where an
/// attribute has not one element for each vertex.
void refine_meshes(nlohmann::json& document, const GltfAsset& asset, const Scene& scene,
                   const Refinement& refinement, std::span<const glm::vec3> normals,
                   AddedData& added);

/// The file of a glTF scene with the triangles cut, as it could stand in its place.
[[nodiscard]] std::string refined_gltf(const Scene& scene, const Refinement& refinement,
                                       std::span<const glm::vec3> normals = {});

}  // namespace surfelao
