/// vertex_target.h: what is asked so that every vertex of a scene gets its value, and how the
/// values come of the answers.
///
///     const VertexTarget target(mesh, settings);
///     const Solution solution = solve(prepared, target.receivers(), ...);
///     write_scene(path, mesh->scene, target.values(solution.occlusion));
#pragma once

#include "bake/vertex_fit.h"
#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/receiver.h"
#include "surfels/scene.h"
#include "surfels/surface.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// Where the values of vertices come from.
enum class VertexValues {
    fit,    ///< samples all over the surface, fitted (vertex_fit.h): what is seen is right
    point,  ///< the vertex itself; where several wedges meet, their mean by angle
};

/// A length as a user says it.
struct Length {
    double value = 0.0;    ///< the file's units or percent
    bool percent = false;  ///< of the bounding-box diagonal
    bool operator==(const Length&) const = default;
};

struct TargetSettings {
    NormalSettings normals = {};
    VertexValues values = VertexValues::fit;
    std::optional<Length> offset = {};         ///< > 0; empty: local (surfels/surface.h)
    std::optional<glm::dvec3> viewpoint = {};  ///< of clouds (surfels/point_cloud.h), as the next
    std::optional<Length> occluder_spacing = {};
    std::optional<glm::vec3> sky = {};  ///< where NormalSource::up looks; empty: along z
    bool operator==(const TargetSettings&) const = default;
};

/// In the unit frame. Throws SettingsError where it is not above 0, InputError where it vanishes
/// beside the scene or is larger than it.
[[nodiscard]] Offset offset_of(const TargetSettings& settings, const Frame& frame);
/// The largest that a receiver then has.
[[nodiscard]] float largest_offset_of(const TargetSettings& settings, const Frame& frame);

/// "normals=auto crease=40 values=fit", and " offset=0.1%" and so on where there is one: for marks
/// and reports.
[[nodiscard]] std::string text_of(const TargetSettings& settings);
[[nodiscard]] std::string name_of(NormalSource source);
[[nodiscard]] std::string name_of(VertexValues values);

/// What values at vertices cannot hold: answers at samples of the surface less what is displayed
/// there. Near the floor, the least error that values at these vertices can have as they are seen.
struct Misfit {
    double rms = 0.0;    ///< over the surface, by area
    double share = 0.0;  ///< of the area: triangles of several samples whose own RMS is above
                         ///< kCoarse; one sample does not show that it is the triangle's size
    double area = 0.0;   ///< that has samples, in the unit frame
};

/// In occlusion: what is seen as a wrong shade.
inline constexpr double kCoarse = 0.05;

class VertexTarget {
public:
    /// mesh: made with settings.normals. O(n). is_folded: see unfold().
    VertexTarget(std::shared_ptr<const Mesh> mesh, const TargetSettings& settings,
                 bool is_folded = false);

    [[nodiscard]] std::span<const Receiver> receivers() const { return receivers_; }

    /// Receivers [first, end) are not asked for any more; with the last all are gone: answers and
    /// what is made of them take memory of their own.
    void forget_receivers(std::size_t first, std::size_t end);

    /// Until then a folded target has no samples (VertexFit::fold): only its receivers are asked
    /// for, and most of the memory that they take is that of the samples they are made of.
    void unfold();

    /// One per scene vertex. answers: one per receiver. Vertices that no triangle uses and that
    /// have no normal get occlusion 0 and no bent normal. O(n).
    [[nodiscard]] std::vector<Occlusion> values(std::span<const Occlusion> answers) const;

    /// The same, but a value depends on the answers around it alone (VertexFit::solve_locally).
    [[nodiscard]] std::vector<Occlusion> values_locally(std::span<const Occlusion> answers) const;

    /// The receivers anew, in their order: the mesh's positions and normals have changed.
    void follow_mesh();

    /// Empty for VertexValues::point, which asks nothing between the vertices. answers and values:
    /// as in values(). O(n), no rays.
    [[nodiscard]] std::optional<Misfit> misfit(std::span<const Occlusion> answers,
                                               std::span<const Occlusion> values) const;

    /// The same for each triangle by itself: RMS over its samples, 0 where it has none.
    [[nodiscard]] std::vector<float> triangle_misfits(std::span<const Occlusion> answers,
                                                      std::span<const Occlusion> values) const;

    /// What the receivers stand for, one for each of the first; null for VertexValues::point.
    [[nodiscard]] const SurfaceSamples* samples() const
    {
        return fit_ ? &fit_->samples() : nullptr;
    }

private:
    void make_receivers(bool folds);
    struct Residuals;
    Residuals residuals(std::span<const Occlusion> answers,
                        std::span<const Occlusion> values) const;
    std::vector<Occlusion> with_lone(std::vector<Occlusion> values,
                                     std::span<const Occlusion> answers) const;
    std::vector<Occlusion> mean_of_wedges(std::span<const Occlusion> answers) const;

    std::shared_ptr<const Mesh> mesh_;
    TargetSettings settings_;
    std::vector<Receiver> receivers_;
    std::optional<VertexFit> fit_;
    std::vector<std::uint32_t> lone_;  ///< fit: vertices that only triangles without area use;
                                       ///< their receivers follow those of the samples
};

/// The displayed value of a surface point: interpolated, as whoever draws the mesh does it.
[[nodiscard]] float displayed(const Geometry& geometry, std::span<const Occlusion> values,
                              const SurfacePoint& point);

}  // namespace surfelao
