/// moving_world.h: the world of an animated glTF, read once: its bodies, and where they are.
///
///     MovingWorld world(input, seconds, target, parts, reading);
///     MovingSolver solver(world, engine);  // moving_solver.h
///     for (...) {
///         world.pose(second);
///         solver.place();
///         solver.solve();
///         write_scene(path, world.scene(), solver.values_of(solver.answers()), ...);
///     }
///
/// A body is what Motion says moves as one. Each has a clean geometry, normals and samples of its
/// own, made once, in the first of the poses in which it is there (as the file stands where it is
/// in none): neither normals nor values are smoothed from one body to another that touches it then.
/// One whose poses are similarities is placed; others are deformed: their triangles and samples
/// stay what they were, their normals follow the triangles.
#pragma once

#include "bake/vertex_target.h"
#include "bake/world.h"
#include "engines/moving.h"
#include "files/motion.h"
#include "files/scene_io.h"
#include "surfels/surface.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {

struct Roles;

/// What BakeReport says of the surface.
struct SurfaceCounts {
    std::uint64_t dropped_triangles = 0, vertices_without_normal = 0, corners_from_file = 0,
                  replaced_corners = 0;
};

class MovingWorld {
public:
    /// seconds: all moments at which it is asked; at least one. reading: its moment tells the
    /// animation. Reads the file once. Throws InputError as read_scene(), Motion and make_world(),
    /// for any of the moments; and where what moves is baked, but none of it occludes.
    MovingWorld(const std::filesystem::path& input, std::span<const double> seconds,
                const TargetSettings& target, const PartChoice& parts, const ReadOptions& reading);

    /// Of all moments together, without what is left out.
    [[nodiscard]] const Box& box() const { return box_; }
    [[nodiscard]] const Frame& frame() const { return occluders_.frame; }
    [[nodiscard]] std::uint32_t body_count() const
    {
        return static_cast<std::uint32_t>(bodies_.size());
    }
    [[nodiscard]] std::uint64_t triangle_count() const;  ///< that are baked
    [[nodiscard]] SurfaceCounts counts() const;          ///< of the bodies, as they were made
    /// What occludes, each body as it was made.
    [[nodiscard]] const Geometry& occluders() const { return occluders_; }
    [[nodiscard]] const std::vector<bool>& unbaked() const { return unbaked_; }

    /// Scenes and receivers are made before the first pose.
    [[nodiscard]] MovingScene scene_for(const EngineChoice& choice) const;
    [[nodiscard]] MovingReceivers receivers_for(const MovingScene& scene,
                                                const MovingSettings& settings) const;
    /// Receivers, body by body.
    [[nodiscard]] std::size_t receiver_count() const { return receiver_count_; }
    [[nodiscard]] std::uint32_t body_of(std::size_t receiver) const;
    [[nodiscard]] bool has_normal(std::size_t receiver) const;
    /// Per receiver, those that stand on triangles which share a vertex with its own, itself too,
    /// within half a crease; of the first pose. Empty for VertexValues::point. O(n).
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> neighbours() const;
    /// Lengths in the frame; the ground lies below all that is there at any moment. offset: the
    /// largest of the receivers.
    [[nodiscard]] Definition definition_for(const DistanceLimit& limit, Kernel kernel,
                                            const std::optional<GroundPlane>& ground,
                                            float offset) const;

    /// Brings bodies and scene() there. One of the moments. O(n).
    void pose(double seconds);
    /// The scene as read_scene() gives it at the moment.
    [[nodiscard]] const Scene& scene() const { return scene_; }
    /// The receivers where they stand then.
    [[nodiscard]] std::vector<Receiver> receivers_now() const;
    [[nodiscard]] const std::string& animation() const { return motion_->name(); }
    /// What pose() has moved. Each scene is placed after each pose, with its receivers where it has
    /// any.
    void place(MovingScene& scene, MovingReceivers* receivers = nullptr) const;

    /// The surface that is asked, as it stands: positions and triangles, body by body; those of
    /// bodies that are gone are there.
    [[nodiscard]] Geometry surface_now() const;
    /// Values of scene vertices at the vertices of surface_now().
    [[nodiscard]] std::vector<Occlusion> on_surface(std::span<const Occlusion> values) const;
    /// Over the vertices that are baked and have a normal, of bodies that are there.
    [[nodiscard]] double mean_occlusion_of(std::span<const Occlusion> values) const;
    /// As VertexTarget::misfit(), over all bodies that are there. answers: one per receiver;
    /// values: one per scene vertex.
    [[nodiscard]] std::optional<Misfit> misfit(std::span<const Occlusion> answers,
                                               std::span<const Occlusion> values) const;
    /// The same of what occludes, without what is gone.
    [[nodiscard]] Geometry occluders_now() const;
    /// The receivers of points of surface_now().
    [[nodiscard]] std::vector<Receiver> receivers_now(std::span<const SurfacePoint> points) const;

private:
    friend class MovingValues;
    /// A vertex of what occludes that stands inside a triangle of the scene (cut_out.h).
    struct InTriangle {
        std::uint32_t triangle = 0;
        glm::dvec2 at{0.0};
    };
    struct Body {
        std::vector<std::uint32_t> parts;
        std::vector<std::uint32_t> vertices;   ///< of the scene, in the order of mesh.scene
        std::shared_ptr<Mesh> mesh;            ///< what is asked of it; null: nothing
        std::unique_ptr<VertexTarget> target;  ///< null as well
        std::size_t first_receiver = 0;
        std::uint32_t first_occluding_vertex = 0;  ///< of occluders_
        std::vector<InTriangle> cut_corners;       ///< behind the body's own vertices
        bool is_soft = false;                      ///< it is deformed
        // deformed ones, as they were made: positions of mesh.geometry, normals of mesh.surface
        std::vector<glm::vec3> made_positions, made_normals;
        glm::dmat4 from_rest{1.0};  ///< others: to where it was made
        // as it stands
        Placement placement = {};
        bool is_gone = false;
        bool has_moved = false;  ///< with the last pose
    };

    void scan(std::span<const double> seconds, const std::vector<bool>& left_out);
    void make_body(std::uint32_t number, const TargetSettings& target, const Roles& roles,
                   const std::vector<bool>& left_out);
    void add_occluders(const Scene& scene, std::uint32_t body);
    void deform(Body& body);
    [[nodiscard]] const Body& owner_of(std::size_t receiver) const;
    [[nodiscard]] glm::vec3 in_unit_frame(const glm::dvec3& position) const;
    [[nodiscard]] std::pair<const Body*, std::uint32_t> find_triangle(std::uint32_t t) const;

    Scene rest_, scene_;
    NormalSettings normals_;
    std::unique_ptr<Motion> motion_;
    Box box_;
    Geometry occluders_;
    std::vector<std::uint32_t> body_of_triangle_;
    std::vector<glm::vec3> occluding_positions_;  ///< deformed bodies': as they stand
    std::vector<bool> unbaked_;
    std::vector<Body> bodies_;
    std::vector<PartPose> poses_;          ///< of the last pose
    std::vector<glm::dvec3> made_;         ///< positions of rest_, where each body is made
    std::vector<glm::vec3> made_normals_;  ///< the same of normals
    Offset offset_;
    std::size_t receiver_count_ = 0;
};

/// Values at the vertices of a moving world.
class MovingValues {
public:
    /// world must outlive it.
    explicit MovingValues(const MovingWorld& world) : world_(world) {}

    /// One per scene vertex, where the world stands. answers: one per receiver. Bodies of which no
    /// answer has changed since the last call have the values that they had, to the bit.
    [[nodiscard]] const std::vector<Occlusion>& of(std::span<const Occlusion> answers);

private:
    const MovingWorld& world_;
    std::vector<Occlusion> answers_, values_;
};

}  // namespace surfelao
