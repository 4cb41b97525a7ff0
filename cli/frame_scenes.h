/// frame_scenes.h: frames of an animation that are baked one by one, as whole scenes.
#pragma once

#include "bake/bake.h"
#include "bake/played_scene.h"

#include <filesystem>
#include <span>
#include <vector>

namespace surfelao {

class FrameScenes {
public:
    /// Reads the file and what occludes it, for all frames. Throws as PlayedScene.
    FrameScenes(const std::filesystem::path& input, std::span<const double> seconds,
                const PartChoice& parts, const ReadOptions& reading);

    /// Of all frames together.
    [[nodiscard]] const Frame& frame() const { return frame_; }

    /// One of the frames; BakeSettings::frame is frame(). Throws as surfelao::bake().
    [[nodiscard]] BakeReport bake(const BakeSettings& settings, const StageProgress& progress);

private:
    PlayedScene scene_;
    std::vector<Scene> others_;
    Frame frame_;
};

}  // namespace surfelao
