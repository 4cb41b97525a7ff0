/// world.h: from files to what is asked and what occludes it: several meshes in one frame.
///
/// Of every file a user may say which parts occlude and which are baked, by the names that they
/// have there (surfels/labels.h). By default all do both, and one file is its own world. Holes that
/// a texture's alpha cuts do not occlude (cut_out.h): that is always so, and for what is asked it
/// changes nothing: values are those of the whole surface.
///
/// The frame is that of the files that are baked, without what is left out of them: files that only
/// occlude (PartChoice::occluders) do not enter it, however large they are, so that neither offsets
/// nor distances in percent of the diagonal change because of them.
#pragma once

#include "files/scene_io.h"
#include "surfels/surface.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// What surfaces are to rays that let light through all over (Opacity::clear).
enum class ClearSurfaces {
    solid,  ///< they occlude as any other
    open,   ///< they do not occlude; they are baked all the same
    cut,    ///< they occlude where their alpha is at least half: leaves painted on BLEND cards
};

/// "solid", "open", "cut"
[[nodiscard]] std::string name_of(ClearSurfaces clear);

/// What takes part, and how.
struct PartChoice {
    /// Patterns of names (is_called): these parts of any of the files take no part: they neither
    /// occlude nor are they baked, and are neither in the frame nor in smooth normals.
    std::vector<std::string> exclude = {};
    /// Patterns of names: only these parts are baked, also where they are excluded: then they do
    /// not occlude. Empty: all that is not excluded.
    std::vector<std::string> receivers = {};
    /// Files in the same coordinates that occlude, but are not baked.
    std::vector<std::filesystem::path> occluders = {};
    ClearSurfaces clear = ClearSurfaces::solid;
    bool alone = false;  ///< of the inputs only what is baked occludes: an object by itself
    bool operator==(const PartChoice&) const = default;
};

/// " exclude=... receivers=... occluders=... transparent=open", each where it is not the default:
/// for marks.
[[nodiscard]] std::string text_of(const PartChoice& choice);

struct BakeWorld {
    /// One per input, in one frame: the geometry of what is baked, and what occludes it. Notes of
    /// the scenes say what was cut, and what lets light through, but occludes.
    std::vector<Mesh> meshes;
};

/// inputs: baked. others: PartChoice::occluders, read. frame: in place of their own. Throws
/// InputError for a pattern that means no name, where nothing of an input is left to be baked, and
/// as make_mesh().
[[nodiscard]] BakeWorld make_world(std::vector<Scene> inputs, std::span<const Scene> others,
                                   const NormalSettings& normals, const PartChoice& choice,
                                   const std::optional<Frame>& frame = {});

/// The files of PartChoice::occluders as they stand: a moment is one of the inputs' animation.
/// Throws as read_scene().
[[nodiscard]] std::vector<Scene> read_others(const PartChoice& choice, ReadOptions reading);

/// Reads the files and makes the world of them. A moment is that of the inputs: others stand as
/// they do. Throws as read_scene() too.
[[nodiscard]] BakeWorld read_world(std::span<const std::filesystem::path> inputs,
                                   const NormalSettings& normals, const PartChoice& choice,
                                   const ReadOptions& reading = {});

/// Of a single input. others, frame: as make_world().
[[nodiscard]] Mesh mesh_of(Scene scene, std::span<const Scene> others,
                           const NormalSettings& normals, const PartChoice& choice,
                           const std::optional<Frame>& frame = {});

/// Of a single input.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& input, const NormalSettings& normals,
                             const PartChoice& choice, const ReadOptions& reading = {});

}  // namespace surfelao
