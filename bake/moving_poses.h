/// moving_poses.h: scenes brought to the poses of a motion.
#pragma once

#include "bake/world.h"
#include "files/motion.h"
#include "files/scene_io.h"
#include "surfels/geometry.h"
#include "surfels/scene.h"

#include <filesystem>
#include <vector>

namespace surfelao {

/// The file at rest, without a note of its animation, which is played.
[[nodiscard]] Scene read_rest(const std::filesystem::path& input, const ReadOptions& reading);

/// PartChoice::occluders. Throws InputError for one without faces.
[[nodiscard]] std::vector<Scene> read_occluders(const PartChoice& choice,
                                                const ReadOptions& reading);

[[nodiscard]] bool is_same_pose(const PartPose& a, const PartPose& b);

/// Brings a scene that is `rest` but for its poses to these: positions, normals and, where a mirror
/// turns them, triangles. O(n).
void move_scene(const Scene& rest, const Motion& motion, const std::vector<PartPose>& poses,
                Scene& scene);

/// Takes what is there of a scene that stands in these poses into the box. O(n).
void include(const Scene& scene, const std::vector<PartPose>& poses,
             const std::vector<bool>& left_out, Box& box);

/// Normals of wedges after their triangles have moved: each triangle takes them along (as the
/// inverse transpose of its own motion does), the mean by area counts.
void follow_triangles(const std::vector<glm::vec3>& made_positions,
                      const std::vector<glm::vec3>& made_normals, Mesh& mesh);

}  // namespace surfelao
