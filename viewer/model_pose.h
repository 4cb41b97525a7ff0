/// model_pose.h: a model with its parts elsewhere: by an animation, and by hand.
///
/// All is told from the model as it was read, the base: its frame stays, its ground stays, and
/// normals turn with what they are on. Of what bends they are made of its triangles anew, smooth
/// where they were so at rest, and are not those that the file's skins and morphs give. Where both
/// move a part, the animation does so first and the hand then moves what it has made of it, about
/// the place where the part's middle is by then.
#pragma once

#include "engines/moving.h"
#include "files/motion.h"
#include "viewer/model.h"
#include "viewer/movables.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// By hand. Turned and scaled about the part's middle, then moved.
struct PartMove {
    glm::dvec3 translation{0.0};              ///< in diagonals
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< of unit length
    double scale = 1.0;                       ///< > 0
    bool operator==(const PartMove&) const = default;
};

/// What moves as one in MovingScene's sense.
struct Body {
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::uint32_t part = kNone;     ///< of the scene, that the animation moves, and others alike
    std::uint32_t movable = kNone;  ///< that is moved by hand: an index into `moved`
    bool operator==(const Body&) const = default;
};

struct Bodies {
    std::vector<Body> list;                  ///< the first one never moves
    std::vector<bool> deforms;               ///< of each: by skins or morphs, never as one piece
    std::vector<std::uint32_t> of_vertex;    ///< of the scene; 0 also where nothing has triangles
    std::vector<std::uint32_t> of_triangle;  ///< of the geometry
    /// Per body but the first: vertices, and wedges of the surface.
    std::vector<std::vector<std::uint32_t>> vertices, wedges;
    /// Per wedge: one smooth place at rest, of one body. Empty where no part is animated.
    std::vector<std::uint32_t> smooth_places;
};

/// motion: of the base's scene, or null. moved: of the movables, those that a hand may move. O(n).
[[nodiscard]] Bodies bodies_of(const Model& base, const Movables& movables,
                               std::span<const std::uint32_t> moved, const Motion* motion);

/// What is drawn. Where a body is gone, its vertices lie in one point.
struct ModelShape {
    std::vector<glm::vec3> positions;      ///< as Geometry's
    std::vector<glm::vec3> normals;        ///< as Geometry's
    std::vector<glm::vec3> wedge_normals;  ///< as Surface's
    std::vector<float> splat_radii;        ///< as Model's
};

enum class BodyState { placed, gone, deformed };
struct BodyPose {
    BodyState state = BodyState::placed;
    Placement placement = {};  ///< of what is placed
    bool operator==(const BodyPose&) const = default;
};

/// A pose, for whoever keeps something of each body.
struct PosedBodies {
    std::shared_ptr<const Model> base;
    std::shared_ptr<const Bodies> bodies;  ///< of it
    std::vector<BodyPose> poses;           ///< one per Bodies::list
};
/// All in their places.
[[nodiscard]] PosedBodies bodies_at_rest(std::shared_ptr<const Model> base,
                                         std::shared_ptr<const Bodies> bodies);

struct ModelPose {
    std::vector<BodyPose> bodies;  ///< one per Bodies::list
    ModelShape shape;
    /// One per `moved`: where the animation has taken its middle; the hand has not moved it yet.
    std::vector<glm::dvec3> middles;
};

/// moves: one per `moved`. parts: Motion::at(), or empty. O(n).
[[nodiscard]] ModelPose pose_of(const Model& base, const Bodies& bodies, const Movables& movables,
                                std::span<const std::uint32_t> moved,
                                std::span<const PartMove> moves, std::span<const PartPose> parts);

/// The placement that a hand's move is, of something whose middle is there. Exactly the identity
/// where the move is none.
[[nodiscard]] Placement placement_of(const PartMove& move, glm::dvec3 middle);

/// What the target asks where the base's surface has that shape, in the target's order. Vertices
/// that no triangle with an area uses are asked where they were.
[[nodiscard]] std::vector<Receiver> receivers_on(const Model& base, const VertexTarget& target,
                                                 const ModelShape& shape);
/// The body of each of them.
[[nodiscard]] std::vector<std::uint32_t> bodies_of_receivers(const Model& base,
                                                             const VertexTarget& target,
                                                             const Bodies& bodies);

/// A model by itself: for pixels, maps, rays, and files. Its vertices are the base's.
[[nodiscard]] Model posed_model(const Model& base, const Bodies& bodies, const ModelPose& pose);

}  // namespace surfelao
