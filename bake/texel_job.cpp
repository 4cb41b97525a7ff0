#include "bake/texel_job.h"

#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/extension.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <string>

namespace surfelao {
namespace {

/// The set to be used; throws where there is none of use.
std::uint32_t chosen_set(const BakeSettings& settings, const Mesh& mesh)
{
    const std::vector<UvSet>& sets = mesh.scene.uvs;
    const std::string name = settings.input.string();
    const auto is_usable = [&](const UvSet& set) {
        return !set.empty() && MapRaster(mesh.geometry, set, {1, 1}).flat_triangles() <
                                   mesh.geometry.triangles.size();
    };
    if (const auto asked = settings.texels->uv_set) {
        if (*asked >= sets.size() || sets[*asked].empty())
            throw InputError(name + ": has no texture coordinates of number " +
                             std::to_string(*asked));
        if (!is_usable(sets[*asked]))
            throw InputError(name +
                             ": no triangle has an area in the texture coordinates of number " +
                             std::to_string(*asked));
        return *asked;
    }
    const auto found = std::ranges::find_if(sets, is_usable);
    if (found == sets.end())
        throw InputError(name +
                         ": has no texture coordinates for a map; bake at the vertices instead");
    return static_cast<std::uint32_t>(found - sets.begin());
}

/// What a user should know of the map.
void add_notes(const BakeReport& report, std::uint64_t triangles, std::vector<std::string>& notes)
{
    const TexelReport& texels = *report.texels;
    const auto per_cent = [](std::uint64_t part, std::uint64_t whole) {
        return fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
    };
    if (texels.overlapping > 0)
        notes.push_back(per_cent(texels.overlapping, texels.covered) +
                        " of the covered texels show several places of the surface: they hold the "
                        "mean, off by " +
                        fixed(texels.spread, 3));
    if (texels.flat_triangles > 0)
        notes.push_back(count_text(texels.flat_triangles, "triangle") + " of " +
                        std::to_string(triangles) + " without a place in the map");
    if (texels.outside_triangles > 0)
        notes.push_back(count_text(texels.outside_triangles, "triangle") +
                        " reach out of the map: it repeats there");
}

}  // namespace

std::filesystem::path bent_path(const std::filesystem::path& output)
{
    std::filesystem::path path = output;
    return path.replace_extension(".bent" + output.extension().string());
}

void check_texel_output(const BakeSettings& settings)
{
    check_map_output(settings.output, settings.texels->depth);
}

void bake_texels(const Mesh& mesh, BakeReport& report, const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    const TexelSettings& texels = *settings.texels;
    TexelReport& told = report.texels.emplace();
    told.uv_set = chosen_set(settings, mesh);
    const MapSettings map_settings{.size = {texels.size, texels.size},
                                   .padding = texels.padding,
                                   .bent = texels.bent,
                                   .depth = texels.depth,
                                   .half_is_whole = lower_extension(settings.output) != ".exr",
                                   .check = settings.check};
    const MapBake map = bake_map(mesh, mesh.scene.uvs[told.uv_set], map_settings, settings.engine,
                                 offset_of(settings.target, mesh.geometry.frame), progress);
    told.covered = map.covered;
    told.overlapping = map.overlapping;
    told.spread = map.spread;
    told.flat_triangles = map.flat_triangles;
    told.outside_triangles = map.outside_triangles;
    report.receivers = map.receivers;
    report.error = map.error;
    report.mean_occlusion = map.mean_occlusion;
    report.seconds.raster = map.seconds.raster;
    report.seconds.surfels = map.seconds.surfels;
    report.seconds.tree = map.seconds.tree;
    report.seconds.solve = map.seconds.solve;
    report.seconds.fill = map.seconds.fill;
    report.seconds.check = map.seconds.check;
    add_notes(report, mesh.geometry.triangles.size(), report.notes);

    if (progress && !progress("write", 0.0))
        throw Cancelled();
    Stopwatch watch;
    if (texels.bent) {
        told.written.push_back(bent_path(settings.output));
        write_map(told.written.back(), map.bent, texels.depth);
    }
    write_map(settings.output, map.visibility, texels.depth);
    report.seconds.write = watch.lap();
}

}  // namespace surfelao
