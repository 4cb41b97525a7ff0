/// frame_options.h: the options of frames of an animation, and the files that they become.
#pragma once

#include "files/scene_io.h"

#include <filesystem>
#include <optional>
#include <span>
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

/// What becomes of frames that are files.
inline constexpr const char* kFramesAreFiles =
    "glTF: frames A to B of an animation, frame N at N / fps seconds, each a file: -o f.%04d.png. "
    "All are measured in one frame of reference";

/// --frames, --fps
void add_frame_options(CLI::App& command, FrameOptions& options,
                       const std::string& help = kFramesAreFiles);

/// Of the frames; empty where none are asked for. Throws UsageError for a range that is none, and
/// for inputs that are not a single glTF.
[[nodiscard]] std::vector<double> seconds_of(const FrameOptions& options,
                                             std::span<const std::string> inputs);

/// A frame: when, and where its result goes.
struct FrameFile {
    Moment moment;
    std::filesystem::path output;
};

/// One per frame; empty where none are asked for. pattern: "f.%04d.png", whose %d becomes the
/// frame's number. reading: its moment tells the animation. Throws UsageError for a range that is
/// none, a pattern without a place for the number, and inputs that are not a single glTF.
[[nodiscard]] std::vector<FrameFile> frames_of(const FrameOptions& options,
                                               std::span<const std::string> inputs,
                                               const std::string& pattern,
                                               const ReadOptions& reading);

}  // namespace surfelao
