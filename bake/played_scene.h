/// played_scene.h: an animated file that is read once and stands at one moment after the other.
///
/// For what is made of a whole scene at each moment: pictures of pixels, maps. Where bodies are
/// kept from moment to moment it is moving_world.h.
#pragma once

#include "bake/world.h"
#include "files/motion.h"
#include "files/scene_io.h"
#include "surfels/scene.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

class PlayedScene {
public:
    /// Reads the file at rest. reading: its moment tells the animation. Throws as read_scene() and
    /// Motion.
    PlayedScene(const std::filesystem::path& input, const ReadOptions& reading);

    /// As read_scene() gives it at that moment, to rounding, but for its tangents, which are those
    /// at rest, and for its asset, which stands at rest. O(n). Throws as Motion::at().
    [[nodiscard]] const Scene& at(double seconds);

    /// The box of all that is there at any of these moments: what moves is measured alike from
    /// first to last in its frame. others: PartChoice::occluders, which are not in it. Throws as
    /// make_world() and Motion::at(). O(n) for each.
    [[nodiscard]] Box box_at(std::span<const double> seconds, const PartChoice& choice,
                             std::span<const Scene> others);

private:
    std::vector<PartPose> move_to(double seconds);

    Scene rest_, scene_;
    Motion motion_;
};

}  // namespace surfelao
