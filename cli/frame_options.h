/// frame_options.h: the options of frames of an animation, and the files that they become.
#pragma once

#include "files/scene_io.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// What was asked for: empty where an option was not given.
struct FrameOptions {
    std::optional<std::string> frames;  ///< "0:47"
    double fps = 24.0;
};

/// --frames, --fps
void add_frame_options(CLI::App& command, FrameOptions& options);

/// A frame: when, and where its result goes.
struct FrameFile {
    Moment moment;
    std::filesystem::path output;
};

/// One per frame; empty where none are asked for. pattern: "f.%04d.png", whose %d becomes the
/// frame's number. animation: Moment::animation. Throws UsageError for a range that is none, and a
/// pattern without a place for the number.
[[nodiscard]] std::vector<FrameFile> frames_of(const FrameOptions& options,
                                               const std::string& pattern,
                                               const std::string& animation);

}  // namespace surfelao
