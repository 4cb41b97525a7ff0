#include "cli/frame_scenes.h"

#include "files/file_type.h"

namespace surfelao {
namespace {

/// Whether the file itself is asked as it stands at the moment, not its surface alone: for its
/// meshes' own spaces and tangents.
bool needs_file(const BakeSettings& settings)
{
    const FileType type = type_of(settings.output);
    const BentSpace bent = settings.texels ? settings.texels->bent : BentSpace::none;
    return type == FileType::gltf || type == FileType::glb || bent == BentSpace::object ||
           bent == BentSpace::tangent;
}

}  // namespace

FrameScenes::FrameScenes(const std::filesystem::path& input, std::span<const double> seconds,
                         const PartChoice& parts, const ReadOptions& reading)
    : scene_(input, reading),
      others_(read_others(parts, reading)),
      frame_(frame_of(scene_.box_at(seconds, parts, others_)))
{
}

BakeReport FrameScenes::bake(const BakeSettings& settings, const StageProgress& progress)
{
    if (needs_file(settings))
        return surfelao::bake(settings, progress);
    return bake_scene(scene_.at(settings.reading.moment->seconds), others_, settings, progress)
        .report;
}

}  // namespace surfelao
