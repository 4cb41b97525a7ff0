#include "bake/bake.h"

#include "bake/notes.h"
#include "bake/peak_memory.h"
#include "bake/texel_job.h"
#include "engines/threads.h"
#include "files/file_type.h"
#include "files/maker_mark.h"
#include "files/scene_io.h"
#include "files/sidecars.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"
#include "surfels/topology.h"

#include <tbb/parallel_invoke.h>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Says which stage begins; the moment at which a job between two stages can be stopped.
void enter(const StageProgress& progress, std::string_view stage)
{
    if (progress && !progress(stage, 0.0))
        throw Cancelled();
}

/// What the engine built is gone afterwards: what follows needs the memory.
VertexBake answer(const Mesh& mesh, const VertexTarget& target, Occluders* occluders,
                  const StageProgress& progress, BakeReport& report)
{
    const BakeSettings& settings = report.settings;
    const Offset offset = offset_of(settings.target, mesh.geometry.frame);
    VertexBake bake = settings.error
                          ? bake_to_error(mesh, target, settings.engine, offset, *settings.error,
                                          settings.check, progress, occluders)
                          : bake_vertices(mesh, target, settings.engine, offset, settings.check,
                                          progress, occluders);
    report.settings.engine = bake.engine;
    report.surfels = bake.surfels;
    report.residual = bake.residual;
    report.error = bake.error;
    report.trials = bake.trials;
    report.is_met = bake.is_met;
    static_cast<VertexBakeSeconds&>(report.seconds) = bake.seconds;
    return bake;
}

/// Solves, writes the output, and fills in the report what is of the values.
void bake_at_vertices(const std::shared_ptr<const Mesh>& mesh, Occluders* occluders,
                      BakeReport& report, const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    Stopwatch stage;
    const VertexTarget target(mesh, settings.target);
    report.receivers = target.receivers().size();
    report.seconds.read += stage.lap();
    const VertexBake baked = answer(*mesh, target, occluders, progress, report);

    enter(progress, "write");
    stage.lap();
    std::vector<std::string> written_notes;
    tbb::parallel_invoke(
        [&] {
            written_notes = write_scene(settings.output, mesh->scene, baked.values,
                                        {settings.colors, settings.encoding, mark_of(settings)});
        },
        [&] {  // a writer leaves cores idle
            report.misfit = target.misfit(baked.answers, baked.values);
            report.notes = notes_of({*mesh, analyse_topology(mesh->geometry),
                                     settings.engine.definition, baked.values, report.misfit});
        });
    report.notes.insert(report.notes.end(), written_notes.begin(), written_notes.end());
    report.mean_occlusion = mean_occlusion_of(mesh->surface, baked.values);
    report.seconds.write = stage.lap();
}

/// The mesh with what a subdivision adds; `occluders` become those of the mesh as it was.
std::shared_ptr<const Mesh> subdivided(const std::shared_ptr<const Mesh>& mesh,
                                       std::optional<Occluders>& occluders, BakeReport& report,
                                       const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    occluders.emplace(mesh->geometry);
    SubdivisionReport& told = report.subdivision.emplace();
    const auto refined = std::make_shared<const Mesh>(subdivided(
        *mesh, *settings.subdivide, settings.target, settings.engine, *occluders, progress, told));
    report.seconds.subdivide = told.seconds;
    return refined;
}

/// What a bake writes beside its output.
std::vector<fs::path> files_beside(const BakeSettings& settings)
{
    std::vector<fs::path> files;
    if (!settings.texels)
        return files;
    if (settings.texels->bent != BentSpace::none)
        files.push_back(bent_path(settings.output));
    for (const auto& file : {map_file_of(settings.output), map_materials_of(settings.output)})
        if (file)
            files.push_back(*file);
    return files;
}

}  // namespace

BakeReport bake(const BakeSettings& settings, const StageProgress& progress)
{
    BakeReport report;
    report.settings = settings;
    report.threads = thread_count();
    Stopwatch whole, stage;
    if (settings.texels)
        check_texel_output(settings);
    else
        check_output(settings.input, settings.output);

    enter(progress, "read");
    const auto read = std::make_shared<const Mesh>(
        make_mesh(read_scene(settings.input), settings.target.normals));
    EngineSettings& engine = report.settings.engine;
    engine.definition = definition_of(settings.max_distance, settings.kernel, read->geometry.frame);
    report.seconds.read = stage.lap();
    std::optional<Occluders> occluders;
    const std::shared_ptr<const Mesh> mesh =
        settings.subdivide ? subdivided(read, occluders, report, progress) : read;
    const Scene& scene = mesh->scene;
    const Geometry& geometry = mesh->geometry;
    if (settings.texels)
        bake_texels(*mesh, report, progress);
    else
        bake_at_vertices(mesh, occluders ? &*occluders : nullptr, report, progress);

    report.vertices = scene.positions.size();
    report.triangles = scene.triangles.size();
    report.dropped_triangles = geometry.dropped_triangles;
    report.vertices_without_normal = static_cast<std::uint64_t>(
        std::count(mesh->surface.normals.begin(), mesh->surface.normals.end(), glm::vec3(0.0f)));
    report.corners_from_file = mesh->surface.corners_from_file;
    report.replaced_corners = mesh->surface.replaced_corners;
    report.seconds.total = whole.lap();
    report.peak_rss_bytes = peak_rss_bytes();
    return report;
}

fs::path output_in_folder(const fs::path& input, const fs::path& folder)
{
    fs::path name = input.filename();
    if (type_of(input) == FileType::stl)
        name.replace_extension(".ply");
    return folder / name;
}

std::string mark_of(const BakeSettings& settings)
{
    const EngineSettings& engine = settings.engine;
    const DistanceLimit& limit = settings.max_distance;
    std::string text;
    const auto add = [&](const char* name, auto value) { append_shortest(text += name, value); };
    if (settings.error) {
        add("error=", *settings.error);
        add(" check=", settings.check);
    } else {
        text = "engine=" + name_of(engine.engine) +
               " device=" + (engine.device == Device::gpu ? "gpu" : "cpu");
        if (engine.engine == Engine::rays)
            text += " rays=" + std::to_string(engine.rays);
        else
            add(" quality=", engine.quality);
        if (engine.engine == Engine::disks) {
            text += " passes=" + std::to_string(engine.passes);
            add(" strength=", engine.strength);
        }
    }
    if (engine.instructions == Instructions::avx2)
        text += " instructions=avx2";
    text += settings.kernel == Kernel::cosine ? " kernel=cosine" : " kernel=bunnell";
    if (std::isfinite(limit.value))
        add(" max_distance=", limit.value);
    else
        text += " max_distance=none";
    text += std::isfinite(limit.value) && limit.percent ? "%" : "";
    text += limit.falloff == Falloff::smooth ? " falloff=smooth" : " falloff=none";
    text += " " + text_of(settings.target);
    if (settings.subdivide)
        add(" subdivide=", *settings.subdivide);
    if (const auto& texels = settings.texels) {
        text += " " + text_of(*texels);
        return make_mark("bake", text);
    }
    text += " colors=" + name_of(settings.colors);
    text += " encoding=" + name_of(settings.encoding);
    return make_mark("bake", text);
}

bool is_finished(const BakeSettings& settings)
{
    std::error_code error;
    const fs::file_time_type made = fs::last_write_time(settings.output, error);
    const bool is_picture = type_of(settings.output) == FileType::unknown;
    if (error || (is_picture ? read_description(settings.output) : read_mark(settings.output)) !=
                     mark_of(settings))
        return false;
    if (!std::ranges::all_of(files_beside(settings), [](const fs::path& file) {
            std::error_code ignored;
            return fs::exists(file, ignored);
        }))
        return false;
    std::vector<fs::path> sources;
    if (settings.texels)
        sources = settings.texels->high;
    if (type_of(settings.input) == FileType::gltf)
        std::ranges::copy(sidecars_of(settings.input), std::back_inserter(sources));
    sources.push_back(settings.input);
    return std::ranges::all_of(sources, [&](const fs::path& source) {
        std::error_code missing;
        const fs::file_time_type changed = fs::last_write_time(source, missing);
        return !missing && made >= changed;
    });
}

}  // namespace surfelao
