#include "bake/texel_job.h"

#include "bake/bent_space.h"
#include "bake/high_to_low.h"
#include "files/file_type.h"
#include "files/scene_io.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/extension.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

namespace surfelao {
namespace {

/// What texels that show several places of the surface may be off by, RMS over the whole map: one
/// that is off by more is no picture of it.
constexpr double kMostSpread = 0.05;

/// Throws where a map that nobody insists on would show a mean of what does not belong together.
void check_overlap(const BakeSettings& settings, const TexelReport& texels)
{
    const double share = static_cast<double>(texels.overlapping) /
                         static_cast<double>(std::max<std::uint64_t>(1, texels.covered));
    if (settings.texels->uvs != UvChoice::automatic || !texels.uv_set ||
        texels.spread * std::sqrt(share) <= kMostSpread)
        return;
    const std::string set = std::to_string(*texels.uv_set);
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
    if (texels.misses > 0)
        notes.push_back(std::to_string(texels.misses) + " points of " +
                        std::to_string(texels.covered) +
                        " texels meet nothing of the high mesh within the cage");
}

/// The fine mesh, where one was asked for, and how the coarse one looks at it.
struct High {
    High(const BakeSettings& settings, const Mesh& low)
        : mesh(read(settings)),
          detail(low, mesh, cage_of(*settings.texels, low.geometry.frame.diagonal))
    {
    }

    static Mesh read(const BakeSettings& settings)
    {
        std::vector<Scene> scenes;
        for (const std::filesystem::path& path : settings.texels->high)
            scenes.push_back(read_scene(path, {.progress = settings.reading.progress}));
        return make_mesh(join(scenes), settings.target.normals);
    }

    static double cage_of(const TexelSettings& texels, double diagonal)
    {
        if (!texels.cage)
            return kCageShare * diagonal;
        return texels.cage->percent ? texels.cage->value / 100.0 * diagonal : texels.cage->value;
    }

    Mesh mesh;
    HighDetail detail;
};

/// Fills in what is of the map.
void report_map(const MapBake& map, BakeReport& report)
{
    TexelReport& told = *report.texels;
    report.settings.engine = map.engine;
    report.trials = map.trials;
    report.is_met = map.is_met;
    report.surfels = map.surfels;
    report.residual = map.residual;
    report.receivers = map.receivers;
    report.error = map.error;
    report.mean_occlusion = map.mean_occlusion;
    report.seconds.raster = map.seconds.raster;
    report.seconds.surfels = map.seconds.surfels;
    report.seconds.tree = map.seconds.tree;
    report.seconds.solve = map.seconds.solve;
    report.seconds.fill = map.seconds.fill;
    report.seconds.check = map.seconds.check;
    told.covered = map.covered;
    told.overlapping = map.overlapping;
    told.spread = map.spread;
    told.hidden = map.hidden;
    told.seams = map.seams;
    told.smooth_seams = map.smooth_seams;
    told.jump = map.jump;
    told.flat_triangles = map.flat_triangles;
    told.outside_triangles = map.outside_triangles;
    told.misses = map.misses;
}

/// The picture of a page: "ao.png", "ao.1001.png" of a tile, "ao.Leather.png" of a material.
std::filesystem::path page_path(const std::filesystem::path& path, const TexelReport& texels,
                                std::size_t page)
{
    if (!texels.tiles.empty())
        return tile_path(path, texels.tiles[page]);
    if (texels.materials.empty())
        return path;
    std::filesystem::path of_material = path;
    return of_material.replace_extension("." + texels.materials[page] + path.extension().string());
}

/// Names of the pages' materials as file names can hold them, each another one.
std::vector<std::string> names_of_pages(const Scene& scene, const MapLayout& layout)
{
    std::vector<std::string> names;
    if (layout.materials.empty())
        return names;
    const BaseColors colors = scene.asset->base_colors();
    for (const std::uint32_t material : layout.materials) {
        std::string name = colors.materials[material].name;
        for (char& c : name)
            if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'))
                c = '_';
        if (name.empty() || std::ranges::find(names, name) != names.end())
            name += std::to_string(material);
        names.push_back(std::move(name));
    }
    return names;
}

/// One picture, or one for each tile or material.
void write_pictures(const std::filesystem::path& path, const std::vector<Map>& pages,
                    const BakeReport& report, std::vector<std::filesystem::path>& written)
{
    const TexelSettings& texels = *report.settings.texels;
    for (std::size_t page = 0; page < pages.size(); ++page) {
        written.push_back(page_path(path, *report.texels, page));
        write_map(written.back(), pages[page], texels.depth, mark_of(report.settings));
    }
}

/// The mesh with its map; adds the files beside it.
std::vector<std::string> write_mesh(const BakeSettings& settings, const Mesh& mesh,
                                    const TexelLayout& place, const std::vector<Map>& pages,
                                    std::vector<std::filesystem::path>& written)
{
    const Scene& scene = mesh.scene;
    const WriteOptions options{.mark = mark_of(settings), .unbaked = mesh.unbaked};
    const std::vector<UvSet>& uvs = place.layout.pages;
    const auto bytes = [&](std::size_t page) {
        return map_bytes(pages[page], settings.texels->depth);
    };
    if (place.layout.is_blended)
        return write_scene_with_blended_map(
            settings.output, scene, {{bytes(0), bytes(1), bytes(2)}, {uvs[0], uvs[1], uvs[2]}},
            options);
    const OcclusionMap picture =
        occlusion_map_of(place.layout, place.uv_set, pages, settings.texels->depth);
    const std::vector<std::string> notes =
        write_scene_with_map(settings.output, scene, picture, options);
    for (const auto& beside : {map_file_of(settings.output), map_materials_of(settings.output)}) {
        if (beside && pages.size() == 1)
            written.push_back(*beside);
    }
    return notes;
}

}  // namespace

std::filesystem::path bent_path(const std::filesystem::path& output)
{
    std::filesystem::path path = output;
    return path.replace_extension(is_map(output) ? ".bent" + output.extension().string()
                                                 : ".bent.png");
}

std::filesystem::path tile_path(const std::filesystem::path& picture, std::uint32_t tile)
{
    std::filesystem::path path = picture;
    return path.replace_extension("." + std::to_string(tile) + picture.extension().string());
}

void check_texel_output(const BakeSettings& settings)
{
    if (is_map(settings.output))
        return check_map_output(settings.output, settings.texels->depth);
    if (settings.texels->blended)
        check_output_with_blended_map(settings.input, settings.output);
    else
        check_output_with_map(settings.input, settings.output);
    if (settings.texels->depth == MapDepth::whole)
        throw InputError(settings.output.string() + ": a map of a mesh has 8 or 16 bits");
}

void bake_texels(const Mesh& mesh, Occluders* occluders, SceneBake& baked,
                 const StageProgress& progress)
{
    BakeReport& report = baked.report;
    const BakeSettings& settings = report.settings;
    const TexelSettings& texels = *settings.texels;
    TexelReport& told = report.texels.emplace();
    if (!settings.output.empty())
        open_images_early();
    Stopwatch watch;
    const MapRoom room{
        .new_places = settings.output.empty() || !is_map(settings.output),
        .several_pages = is_map(settings.output) || is_gltf(type_of(settings.output))};
    TexelLayout place = layout_for(
        mesh, texels, room, [&](double done) { return !progress || progress("charts", done); });
    const MapLayout& layout = place.layout;
    told.size = layout.size;
    told.uv_set = place.uv_set;
    told.tiles = layout.tiles;
    told.materials = names_of_pages(mesh.scene, layout);
    told.charts = place.charts;
    report.seconds.charts = watch.lap();
    report.notes = mesh.scene.notes;
    if (!place.why_new.empty())
        report.notes.push_back("new texture coordinates: " + place.why_new);
    std::optional<High> high;
    if (!texels.high.empty()) {
        if (progress && !progress("read", 0.0))
            throw Cancelled();
        high.emplace(settings, mesh);
        told.high_triangles = high->mesh.scene.triangles.size();
        told.matched_parts = high->detail.matched_parts();
    }
    const MapSettings map_settings{
        .padding = texels.padding,
        .bent = bent_encoder(mesh, layout, texels.bent, texels.green_down),
        .joins_bent = texels.bent != BentSpace::tangent,
        .depth = texels.depth,
        .half_is_whole = lower_extension(settings.output) != ".exr",
        .check = settings.check};
    const Frame& frame = high ? high->mesh.geometry.frame : mesh.geometry.frame;
    EngineSettings engine = settings.engine;
    engine.definition = definition_of(settings.max_distance, settings.kernel, frame);
    engine.definition.ground = settings.engine.definition.ground;
    if (high && settings.ground) {  // it has a frame of its own
        engine.definition.ground = ground_of(settings.ground, {high->mesh.geometry},
                                             largest_offset_of(settings.target, frame));
        report.ground = text_of(*engine.definition.ground, frame);
    }
    const Offset offset = offset_of(settings.target, frame);
    const HighDetail* detail = high ? &high->detail : nullptr;
    MapBake map = settings.error ? bake_map_to_error(mesh, layout, map_settings, engine, offset,
                                                     *settings.error, progress, detail, occluders)
                                 : bake_map(mesh, layout, map_settings, engine, offset, progress,
                                            detail, occluders);
    report_map(map, report);
    check_overlap(settings, told);
    add_notes(report, mesh.geometry.triangles.size(), report.notes);
    if (settings.output.empty()) {
        baked.layout = std::move(place.layout);
        baked.map = std::move(map);
        return;
    }

    if (progress && !progress("write", 0.0))
        throw Cancelled();
    watch.lap();
    if (!map.bent.empty())
        write_pictures(bent_path(settings.output), map.bent, report, told.written);
    if (is_map(settings.output)) {
        write_pictures(settings.output, map.visibility, report, told.written);
    } else {
        const std::vector<std::string> notes =
            write_mesh(settings, mesh, place, map.visibility, told.written);
        report.notes.insert(report.notes.end(), notes.begin(), notes.end());
    }
    report.seconds.write = watch.lap();
}

}  // namespace surfelao
