/// moving_stage.h: scenes that move, for moving_tables: bodies, their poses, what is asked of them.
#pragma once

#include "engines/moving.h"
#include "image/image.h"
#include "surfels/scene.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

struct MovingStage {
    std::string name;
    Geometry geometry;  ///< at rest
    std::vector<std::uint32_t> body_of_triangle;
    std::vector<Receiver> receivers;  ///< at rest, one per vertex
    std::vector<std::uint32_t> body_of_receiver;
    std::vector<std::vector<Placement>> poses;  ///< per frame, per body; the first one's stays

    [[nodiscard]] std::size_t bodies() const { return poses.front().size(); }
    [[nodiscard]] bool is_static(std::size_t receiver) const
    {
        return body_of_receiver[receiver] == 0;
    }
    /// Frames beyond the last one begin anew.
    [[nodiscard]] const Placement& pose(std::uint32_t body, int frame) const;
    void place(MovingScene& scene, int frame) const;
    [[nodiscard]] Receiver receiver_at(std::size_t receiver, int frame) const;
    /// For engines that look at triangles alone, and for disks.
    [[nodiscard]] Geometry geometry_at(int frame) const;
    /// No body covers more than MovingSettings::tolerance of its hemisphere.
    [[nodiscard]] bool is_far(std::size_t receiver, int frame) const;

    /// Each value becomes the mean of itself and of its neighbours' mean, `passes` times.
    void smooth(std::vector<Occlusion>& answers, int passes) const;
    /// Visibility as light on the triangles, seen from the side, into a part of the image.
    void draw(std::span<const Occlusion> answers, int frame, glm::ivec2 corner, glm::ivec2 size,
              Image& image) const;

    /// Fills what follows from the bodies: one scene each, and per frame where each of them is in
    /// the world. The frame of reference holds all poses.
    MovingStage(std::string title, const std::vector<Scene>& parts,
                const std::vector<std::vector<Placement>>& world_poses);

private:
    struct Ball {
        glm::vec3 centre;
        float radius;
    };
    std::vector<Ball> balls_;  ///< per body, at rest
    std::vector<std::uint32_t> first_neighbour_, neighbours_;
};

/// A body of a seventh of the world's size that moves through its middle by 1/450 of its diagonal a
/// frame.
[[nodiscard]] MovingStage crossing_stage(const std::string& name, const Scene& world, Scene body);
/// Eleven parts that walk on a floor: boxes, a ball and capsules of 53,000 triangles.
[[nodiscard]] MovingStage robot_stage();
[[nodiscard]] MovingStage small_stage();

// In the place of models that are not there.
[[nodiscard]] Scene generated_body();
[[nodiscard]] Scene generated_ground();
[[nodiscard]] Scene generated_scan();
[[nodiscard]] Scene generated_room();

}  // namespace surfelao
