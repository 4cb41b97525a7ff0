#include "bake/texel_job.h"

#include "files/file_type.h"
#include "files/scene_io.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/extension.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace surfelao {
namespace {

/// What texels that show several places of the surface may be off by, RMS over the whole map: one
/// that is off by more is no picture of it.
constexpr double kMostSpread = 0.05;

/// The set to be used; throws where there is none of use.
std::uint32_t chosen_set(const BakeSettings& settings, const Mesh& mesh)
{
    const std::vector<UvSet>& sets = mesh.scene.uvs;
    const auto fail = [&](const std::string& fault) {
        throw InputError(settings.input.string() + ": " + fault);
    };
    std::uint32_t set = settings.texels->uv_set.value_or(0);
    if (!settings.texels->uv_set)
        while (set < sets.size() && sets[set].empty())
            ++set;
    if (set >= sets.size() || sets[set].empty())
        fail(settings.texels->uv_set ? "has no texture coordinates of number " + std::to_string(set)
                                     : "has no texture coordinates for a map; bake at the vertices "
                                       "instead");
    const std::string coordinates = "the texture coordinates of number " + std::to_string(set);
    const MapRaster raster(mesh.geometry, sets[set], {1, 1});
    if (raster.sheets() > kMostSheets)
        fail(coordinates + " cover the map " + fixed(raster.sheets(), 0) +
             " times over: no map can hold that");
    if (raster.flat_triangles() == mesh.geometry.triangles.size())
        fail("no triangle has an area in " + coordinates);
    return set;
}

/// Throws where a map that nobody insists on would show a mean of what does not belong together.
void check_overlap(const BakeSettings& settings, const TexelReport& texels)
{
    const double share = static_cast<double>(texels.overlapping) /
                         static_cast<double>(std::max<std::uint64_t>(1, texels.covered));
    if (settings.texels->uv_set || texels.spread * std::sqrt(share) <= kMostSpread)
        return;
    const std::string set = std::to_string(texels.uv_set);
    throw InputError(settings.input.string() + ": " + fixed(100.0 * share, 1) +
                     " % of the texels show several places of the surface, which differ by " +
                     fixed(texels.spread, 2) + ": the texture coordinates of number " + set +
                     " are for other maps (--uv " + set + " takes the mean all the same)");
}

/// A picture; else a glTF that gets the map.
bool is_map(const std::filesystem::path& output)
{
    return type_of(output) == FileType::unknown;
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
    return path.replace_extension(is_map(output) ? ".bent" + output.extension().string()
                                                 : ".bent.png");
}

void check_texel_output(const BakeSettings& settings)
{
    if (is_map(settings.output))
        return check_map_output(settings.output, settings.texels->depth);
    check_output_with_map(settings.input, settings.output);
    if (settings.texels->depth == MapDepth::whole)
        throw InputError(settings.output.string() + ": a map in glTF has 8 or 16 bits");
}

void bake_texels(const Mesh& mesh, BakeReport& report, const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    const TexelSettings& texels = *settings.texels;
    TexelReport& told = report.texels.emplace();
    told.uv_set = chosen_set(settings, mesh);
    const MapSettings map_settings{.padding = texels.padding,
                                   .bent = texels.bent,
                                   .depth = texels.depth,
                                   .half_is_whole = lower_extension(settings.output) != ".exr",
                                   .check = settings.check};
    const MapLayout layout{.size = {texels.size, texels.size},
                           .pages = {mesh.scene.uvs[told.uv_set]}};
    const Offset offset = offset_of(settings.target, mesh.geometry.frame);
    const MapBake map =
        settings.error ? bake_map_to_error(mesh, layout, map_settings, settings.engine, offset,
                                           *settings.error, progress)
                       : bake_map(mesh, layout, map_settings, settings.engine, offset, progress);
    report.settings.engine = map.engine;
    report.trials = map.trials;
    report.is_met = map.is_met;
    report.surfels = map.surfels;
    report.residual = map.residual;
    told.covered = map.covered;
    told.overlapping = map.overlapping;
    told.spread = map.spread;
    told.hidden = map.hidden;
    told.seams = map.seams;
    told.smooth_seams = map.smooth_seams;
    told.jump = map.jump;
    told.flat_triangles = map.flat_triangles;
    told.outside_triangles = map.outside_triangles;
    check_overlap(settings, told);
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
        write_map(told.written.back(), map.bent[0], texels.depth);
    }
    if (is_map(settings.output)) {
        write_map(settings.output, map.visibility[0], texels.depth);
    } else {
        const std::vector<std::string> notes =
            write_scene_with_map(settings.output, mesh.scene,
                                 {map_bytes(map.visibility[0], texels.depth), told.uv_set, {}},
                                 {.mark = mark_of(settings)});
        report.notes.insert(report.notes.end(), notes.begin(), notes.end());
        if (const auto beside = map_file_of(settings.output))
            told.written.push_back(*beside);
    }
    report.seconds.write = watch.lap();
}

}  // namespace surfelao
