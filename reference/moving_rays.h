/// moving_rays.h: rays in a scene whose bodies move: the opponent of every frame.
///
///     MovingRayScene scene(geometry, body_of_triangle);
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

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>

namespace surfelao {

/// One thread at a time may move it; what now() gives is for any number.
class MovingRayScene {
public:
    /// body_of_triangle: one per triangle; bodies stand at rest. O(n log n). Throws as RayScene.
    MovingRayScene(const Geometry& geometry, std::span<const std::uint32_t> body_of_triangle,
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

    /// As the bodies stand now; valid until one of them moves. Throws std::runtime_error where
    /// Embree refuses.
    [[nodiscard]] const RayScene& now();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao
