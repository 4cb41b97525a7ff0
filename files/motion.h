/// motion.h: how the parts of an animated glTF move, read once and asked often.
///
///     const Motion motion(scene, "Walk");                   // of read_scene()
///     const std::vector<PartPose> poses = motion.at(1.5);   // one per Scene::parts
///
/// The parts are those of the scene at rest: same order, vertices and triangles at every moment.
/// What read_scene() with a moment gives stands here as what moved it. (It also turns the triangles
/// of parts that a moment mirrors; here a placement that mirrors does.)
#pragma once

#include "surfels/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {

/// Where one part of a scene is at a moment.
struct PartPose {
    /// From where the part stands at rest to where it is now, in world units. The identity where it
    /// is deformed. May be sheared, and flat.
    glm::dmat4 from_rest{1.0};
    /// There is nothing of it: a scale of zero, in two directions at least. It stands where that
    /// brings it.
    bool is_gone = false;
    /// Of parts that deform (Motion::deforms): world positions and normals (of unit length, zero or
    /// empty where the file has none), one per vertex of the part. Empty for others.
    std::vector<glm::dvec3> positions = {};
    std::vector<glm::vec3> normals = {};
};

class Motion {
public:
    /// rest: as read_scene() gives it, without a moment or at one; it need not live on. animation:
    /// its name, or its number from 0; empty: the first. Throws InputError where the scene is no
    /// glTF, where it has no such animation, where that moves no node, and as read_scene() with a
    /// moment. O(keys + vertices of deformed parts).
    explicit Motion(const Scene& rest, const std::string& animation = {});
    ~Motion();
    Motion(Motion&&) noexcept;
    Motion& operator=(Motion&&) noexcept;

    /// "Walk"; "1" where it has no name.
    [[nodiscard]] const std::string& name() const;
    /// "animation 0 "Walk" at 1.5 s"
    [[nodiscard]] std::string text_at(double seconds) const;
    [[nodiscard]] double first_seconds() const;  ///< of its first key
    [[nodiscard]] double last_seconds() const;   ///< of its last one

    /// Per part: 0 where it never moves, else a number from 1 on that it shares with what moves as
    /// it does: rigid parts have one from_rest at every moment, to the bit; deformed ones one skin,
    /// or one node. A part moves where a channel moves its node, one above, a joint of its skin or
    /// one above that, or its weights, unless all keys are what the value is at rest.
    [[nodiscard]] const std::vector<std::uint32_t>& bodies() const;
    [[nodiscard]] std::uint32_t body_count() const;  ///< with body 0; >= 1
    /// Per part, whether its poses are positions: skins and morphs, and what is so flat or small at
    /// rest that its shape cannot be told from there.
    [[nodiscard]] const std::vector<bool>& deforms() const;

    /// One per part. Throws InputError naming a node whose pose is not finite. Any number of
    /// threads. O(nodes + vertices of deformed parts * their targets and joints).
    [[nodiscard]] std::vector<PartPose> at(double seconds) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

/// Names of the animations of a glTF that was read, "" where one has none; empty for others.
[[nodiscard]] std::vector<std::string> animations_of(const Scene& scene);

}  // namespace surfelao
