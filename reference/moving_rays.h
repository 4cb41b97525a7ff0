/// moving_rays.h: rays in a scene whose bodies move: the opponent of every frame.
///
///     MovingRayScene scene(geometry, split_bodies(geometry, body_of_triangle));
///     scene.place(1, matrix);
///     trace_occlusion(scene.now(), receivers, options);
///
/// Built to be fast: each body is an Embree mesh with a hierarchy of its own, made once (medium
/// quality) and refitted in place where the body moves. The vertices are those that a scene built
/// there would have, and so are the answers, bit by bit but where a ray passes through an edge. On
/// eleven bodies of 53,000 triangles a frame's update takes a ninth of building anew, and rays a
/// tenth longer; instances, which refit nothing, lose in tracing what they save in refitting.
#pragma once

#include "reference/rays.h"
#include "surfels/bodies.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// One thread at a time may move it; what now() gives is for any number.
class MovingRayScene {
public:
    /// bodies: split_bodies(geometry); they stand at rest. O(n log n). Throws as RayScene.
    MovingRayScene(const Geometry& geometry, std::vector<BodyMesh> bodies,
                   RayScene::Isa isa = RayScene::Isa::best);
    ~MovingRayScene();
    MovingRayScene(MovingRayScene&&) noexcept;
    MovingRayScene& operator=(MovingRayScene&&) noexcept;

    /// matrix: affine, from where the body was prepared to where it is. O(n).
    void place(std::uint32_t body, const glm::dmat4& matrix);
    /// It is not hit until it is placed or deformed.
    void hide(std::uint32_t body);
    /// positions: one per vertex of the geometry; others than the body's are not looked at. O(n).
    void deform(std::uint32_t body, std::span<const glm::vec3> positions);

    /// As the bodies stand now; valid until one of them moves. For trace_occlusion alone: the
    /// triangles of its hits are counted within each body. Throws std::runtime_error where
    /// Embree refuses; the next call tries again.
    [[nodiscard]] const RayScene& now();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao
