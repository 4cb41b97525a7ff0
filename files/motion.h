/// motion.h: how the parts of an animated glTF move, read once and asked often.
///
///     const Motion motion(path, "Walk");
///     const std::vector<PartPose> poses = motion.at(1.5);   // one per Scene::parts
///
/// The parts are those of read_scene() of the same file: same order, vertices and triangles, at
/// every moment. What read_scene() with that moment gives stands here as what moved it.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {

/// Where one part of a scene is at a moment.
struct PartPose {
    /// From where the part stands in the scene that Motion::rest() read to where it is now, in
    /// world units. The identity where it is deformed.
    glm::dmat4 from_rest{1.0};
    /// A scale of zero on the way up, or KHR_node_visibility: there is nothing of it.
    bool is_gone = false;
    /// Skins and morphs: world positions and normals (of any length, empty where the file has
    /// none), one per vertex of the part; empty where it moves as one.
    std::vector<glm::dvec3> positions = {};
    std::vector<glm::vec3> normals = {};
};

class Motion {
public:
    /// animation: as Moment::animation. Throws InputError as read_scene() with a moment, and where
    /// the file has no animation.
    explicit Motion(const std::filesystem::path& path, const std::string& animation = {});
    ~Motion();
    Motion(Motion&&) noexcept;
    Motion& operator=(Motion&&) noexcept;

    /// "Walk"; "1" where it has no name.
    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] double first_seconds() const;  ///< of its first key
    [[nodiscard]] double last_seconds() const;   ///< of its last one
    /// Per part, whether it moves at all: by channels of its node, of those above, of its joints,
    /// or of its weights.
    [[nodiscard]] const std::vector<bool>& moves() const;

    /// O(nodes + keys read + vertices of deformed parts). Any number of threads.
    [[nodiscard]] std::vector<PartPose> at(double seconds) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

/// Names of the animations of a glTF, "" where one has none; empty for other files. Reads the file.
[[nodiscard]] std::vector<std::string> animations_of(const std::filesystem::path& path);

}  // namespace surfelao
