/// moving_bake.h: the job: an animated glTF in, a file with values at vertices for each frame out.
///
/// The file is read once, each body's samples, normals and fit are made once (moving_world.h), and
/// the engine keeps what it knows from frame to frame (engines/moving.h): a vertex near which
/// nothing changes keeps its value to the bit.
#pragma once

#include "bake/bake.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Whether bake_frames() is for such settings: values at vertices, by an engine on the CPU. Others
/// are baked frame by frame (bake).
[[nodiscard]] bool is_for_bodies(const BakeSettings& settings);

/// Told of each frame when its file is there; nothing: it was finished before.
using FrameDone = std::function<void(std::size_t frame, std::optional<BakeReport> report)>;

/// frames: they differ in output and reading.moment only; BakeSettings::frame is found here, and
/// marks have it. resume: frames that are finished are left as they are. Outputs appear one after
/// the other, each complete or not at all: after any exception those that were told are whole, and
/// no other is there. BakeReport::motion has what a frame took; the first one's also what was made
/// once. Throws as bake(); for what is malformed at any of the moments before there is an output.
///
/// Into .glb and .gltf the file is read again for each frame: directions stand there in the space
/// of the meshes.
void bake_frames(std::span<const BakeSettings> frames, bool resume, const FrameDone& done,
                 const StageProgress& progress = {});

}  // namespace surfelao
