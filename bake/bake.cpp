#include "bake/bake.h"

#include "bake/grid_job.h"
#include "bake/moving_bake.h"
#include "bake/notes.h"
#include "bake/peak_memory.h"
#include "bake/point_job.h"
#include "bake/texel_job.h"
#include "engines/moving.h"
#include "engines/threads.h"
#include "files/file_type.h"
#include "files/gltf_new.h"
#include "files/maker_mark.h"
#include "files/scene_io.h"
#include "files/sidecars.h"
#include "grid/grid_file.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/folded_mesh.h"
#include "surfels/for_all.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"
#include "surfels/topology.h"

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

}  // namespace

void take(const VertexBake& bake, BakeReport& report)
{
    report.settings.engine = bake.engine;
    report.surfels = bake.surfels;
    report.residual = bake.residual;
    report.error = bake.error;
    report.trials = bake.trials;
    report.is_met = bake.is_met;
    static_cast<VertexBakeSeconds&>(report.seconds) = bake.seconds;
}

namespace {

/// One file of a world, and the engines of the whole; null where it is the only one.
struct Job {
    std::shared_ptr<Mesh> mesh;
    Occluders* occluders = nullptr;
};

/// Throws InputError where the answers are not those of this mesh.
VertexBake bake_merged(const Mesh& mesh, const VertexTarget& target, const BakeSettings& settings,
                       const Offset& offset, const StageProgress& progress)
{
    const MergedAnswers& merged = *settings.merged;
    std::vector<Occlusion> answers = merged.answers;
    if (answers.size() != target.receivers().size() ||
        question_of(mesh.occluding(), target.receivers()) != merged.question)
        throw InputError(settings.input.string() + ": is not as it was when its parts were baked");
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if (target.receivers()[i].normal == glm::vec3(0.0f))
            answers[i] = {};
        else if (answers[i] == kUnsolved)
            throw InputError(settings.input.string() + ": no part answers receiver " +
                             std::to_string(i));
    }
    VertexBake solved;
    solved.engine = settings.engine;
    solved.answers = std::move(answers);
    solved.surfels = merged.surfels;
    solved.residual = merged.residual;
    return bake_answers(mesh, target, std::move(solved), offset, settings.check, progress);
}

/// engines: of this bake alone, gone as soon as they have answered; empty: those of the job, or
/// none. The target's receivers are gone then too: large meshes need the memory.
VertexBake answer(const Job& job, std::optional<Occluders>& engines, VertexTarget& target,
                  const StageProgress& progress, BakeReport& report)
{
    const BakeSettings& settings = report.settings;
    const Mesh& mesh = *job.mesh;
    const Offset offset = offset_of(settings.target, mesh.geometry.frame);
    VertexBake bake;
    if (settings.merged) {
        bake = bake_merged(mesh, target, settings, offset, progress);
    } else if (settings.error) {
        bake = bake_to_error(mesh, target, settings.engine, offset, *settings.error, settings.check,
                             progress, engines ? &*engines : job.occluders);
    } else {
        FoldedCorners corners(*job.mesh);
        VertexBake solved = solve_vertices(
            mesh, target, settings.engine, progress, engines ? &*engines : job.occluders,
            [&](std::size_t first, std::size_t end) { target.forget_receivers(first, end); });
        engines.reset();
        target.forget_receivers(0, target.receivers().size());
        target.unfold();
        corners.unfold();
        bake = bake_answers(mesh, target, std::move(solved), offset, settings.check, progress);
    }
    take(bake, report);
    return bake;
}

/// Solves a share and writes its file.
void bake_part(const Mesh& mesh, Occluders& occluders, const VertexTarget& target,
               BakeReport& report, const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    const VertexBake solved = solve_vertices(mesh, target, settings.engine, progress, &occluders);
    report.surfels = solved.surfels;
    report.residual = solved.residual;
    static_cast<VertexBakeSeconds&>(report.seconds) = solved.seconds;
    PartFile part{.mark = mark_of(settings),
                  .input = fs::absolute(settings.input),
                  .output = fs::absolute(settings.output),
                  .arguments = settings.share->arguments,
                  .share = settings.share->share,
                  .question = question_of(mesh.occluding(), target.receivers()),
                  .receivers = target.receivers().size(),
                  .surfels = solved.surfels,
                  .residual = solved.residual,
                  .solved = {},
                  .answers = {}};
    for (std::uint32_t i = 0; i < solved.answers.size(); ++i) {
        if (solved.answers[i] == kUnsolved || target.receivers()[i].normal == glm::vec3(0.0f))
            continue;
        part.solved.push_back(i);
        part.answers.push_back(solved.answers[i]);
    }
    report.solved = part.solved.size();
    enter(progress, "write");
    Stopwatch watch;
    write_part(part_path(settings.output, settings.share->share), part);
    report.seconds.write = watch.lap();
}

/// Solves, writes the output if there is one, and fills in the report what is of the values.
std::vector<Occlusion> bake_at_vertices(const Job& job, BakeReport& report,
                                        const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    const std::shared_ptr<Mesh>& mesh = job.mesh;
    FoldedScene folded(*mesh);
    std::optional<Occluders> own;
    PrepareSeconds built;
    if (job.occluders == nullptr && !settings.merged) {
        // building needs much memory on the way: it is done before there is what will be asked
        enter(progress, "build");
        FoldedCorners corners(*mesh);
        built = own.emplace(mesh->occluding()).prepared_for(settings.engine).seconds();
        corners.unfold();
    }
    const auto add_built = [&] {
        report.seconds.surfels += built.surfels;
        report.seconds.tree += built.tree;
    };
    Stopwatch stage;
    const bool asks_once = !settings.merged && !settings.error && !settings.share;
    std::optional<VertexTarget> target(std::in_place, mesh, settings.target, asks_once);
    report.receivers = target->receivers().size();
    report.seconds.read += stage.lap();
    if (settings.share) {
        bake_part(*mesh, own ? *own : *job.occluders, *target, report, progress);
        add_built();
        folded.unfold();
        return {};
    }
    VertexBake baked = answer(job, own, *target, progress, report);
    add_built();

    enter(progress, "write");
    stage.lap();
    report.misfit = target->misfit(baked.answers, baked.values);
    target.reset();
    baked.answers = std::vector<Occlusion>();
    folded.unfold();
    std::vector<std::string> written_notes;
    do_both(
        [&] {
            if (settings.output.empty())
                return;
            written_notes = write_scene(settings.output, mesh->scene, baked.values,
                                        {.colors = settings.colors,
                                         .encoding = settings.encoding,
                                         .mark = mark_of(settings),
                                         .unbaked = mesh->unbaked});
        },
        [&] {  // a writer leaves cores idle
            report.notes = notes_of({*mesh, analyse_topology(mesh->geometry),
                                     settings.engine.definition, baked.values, report.misfit});
        });
    report.notes.insert(report.notes.end(), written_notes.begin(), written_notes.end());
    report.mean_occlusion = mean_occlusion_of(mesh->surface, baked.values);
    report.seconds.write = stage.lap();
    return std::move(baked.values);
}

/// What a bake writes beside its output.
std::vector<fs::path> files_beside(const BakeSettings& settings)
{
    std::vector<fs::path> files;
    if (settings.grid)
        files.push_back(grid_text_path(settings.output));
    if (!settings.texels)
        return files;
    if (settings.texels->bent != BentSpace::none)
        files.push_back(bent_path(settings.output));
    for (const auto& file : {map_file_of(settings.output), map_materials_of(settings.output)})
        if (file)
            files.push_back(*file);
    return files;
}

void check_before_work(const BakeSettings& settings, bool is_alone)
{
    if (settings.grid)
        check_grid_job(settings);
    else if (settings.texels)
        check_texel_output(settings);
    else
        check_output(settings.input, settings.output);
    const bool has_high = settings.texels && !settings.texels->high.empty();
    if (has_high && !(is_alone && settings.parts.occluders.empty()))
        throw InputError(settings.output.string() +
                         ": with a high mesh nothing but it occludes, no other files");
}

/// As the settings ask, below all of these.
void set_ground(std::initializer_list<std::reference_wrapper<const Geometry>> geometries,
                BakeReport& report)
{
    const Frame& frame = geometries.begin()->get().frame;
    std::optional<Ground>& ground = report.settings.engine.definition.ground;
    ground = ground_of(report.settings.ground, geometries,
                       largest_offset_of(report.settings.target, frame));
    if (ground)
        report.ground = text_of(*ground, frame);
}

/// The job with its mesh subdivided; own: its engines, where it has none.
Job subdivided(const Job& job, std::optional<Occluders>& own, BakeReport& report,
               const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    Job refined = job;
    if (refined.occluders == nullptr)
        refined.occluders = &own.emplace(job.mesh->occluding());
    SubdivisionReport& told = report.subdivision.emplace();
    refined.mesh =
        std::make_shared<Mesh>(subdivided(*job.mesh, *settings.subdivide, settings.target,
                                          settings.engine, *refined.occluders, progress, told));
    report.seconds.subdivide = told.seconds;
    return refined;
}

/// One file of the world.
SceneBake bake_one(const Job& read, const BakeSettings& settings, double read_seconds,
                   const StageProgress& progress)
{
    SceneBake baked;
    BakeReport& report = baked.report;
    report.settings = settings;
    report.threads = thread_count();
    report.seconds.read = read_seconds;
    Stopwatch whole;
    if (!settings.texels && !settings.grid && !settings.output.empty())
        check_output(read.mesh->scene, settings.output);
    report.settings.engine.definition = definition_of(
        report.settings.max_distance, report.settings.kernel, read.mesh->geometry.frame);
    set_ground({read.mesh->geometry, read.mesh->occluding()}, report);
    std::optional<Occluders> own;
    const Job job = settings.subdivide ? subdivided(read, own, report, progress) : read;
    const Mesh& mesh = *job.mesh;
    const Geometry& geometry = mesh.geometry;
    if (settings.share)
        report.settings.engine.share = settings.share->share;
    if (report.settings.grid)
        bake_at_grid(mesh, report, progress);
    else if (report.settings.texels)
        bake_texels(mesh, job.occluders, baked, progress);
    else
        baked.values = bake_at_vertices(job, report, progress);

    report.vertices = mesh.scene.positions.size();
    report.triangles = mesh.scene.triangles.size();
    report.dropped_triangles = geometry.dropped_triangles;
    report.baked_triangles = geometry.triangles.size();
    report.occluding_triangles = mesh.occluding().triangles.size();
    report.vertices_without_normal = vertices_without_normal(mesh);
    report.corners_from_file = mesh.surface.corners_from_file;
    report.replaced_corners = mesh.surface.replaced_corners;
    report.seconds.total = read_seconds + whole.lap();
    report.peak_rss_bytes = peak_rss_bytes();
    return baked;
}

/// watch: since the reading of the scene began.
SceneBake bake_read(Scene scene, std::span<const Scene> others, const BakeSettings& settings,
                    Stopwatch& watch, const StageProgress& progress)
{
    check_points(settings, scene);
    if (!scene.triangles.empty()) {
        PartChoice parts = settings.parts;
        parts.alone = settings.grid.has_value();
        std::vector<Scene> input;
        input.push_back(std::move(scene));
        BakeWorld world =
            make_world(std::move(input), others, settings.target.normals, parts, settings.frame);
        const Job job{std::make_shared<Mesh>(std::move(world.meshes.front()))};
        return bake_one(job, settings, watch.lap(), progress);
    }
    if (settings.share)
        throw InputError(settings.input.string() + ": has points only, --part is for faces");
    SceneBake baked;
    BakeReport& report = baked.report;
    report.settings = settings;
    report.threads = thread_count();
    report.vertices = scene.positions.size();
    report.seconds.read = watch.lap();
    baked.values = bake_at_points(scene, report, progress);
    report.seconds.total = report.seconds.read + watch.lap();
    report.peak_rss_bytes = peak_rss_bytes();
    return baked;
}

}  // namespace

BakeReport bake(const BakeSettings& settings, const StageProgress& progress)
{
    check_before_work(settings, true);
    enter(progress, "read");
    Stopwatch watch;
    Scene scene = read_scene(settings.input, settings.reading);
    if (is_gltf(type_of(settings.output)))
        scene = as_gltf(settings.input, std::move(scene), settings.target.normals);
    const std::vector<Scene> others = read_others(settings.parts, settings.reading);
    return bake_read(std::move(scene), others, settings, watch, progress).report;
}

SceneBake bake_scene(Scene scene, std::span<const Scene> others, const BakeSettings& settings,
                     const StageProgress& progress)
{
    if (!settings.output.empty())
        check_before_work(settings, true);
    enter(progress, "read");
    Stopwatch watch;
    return bake_read(std::move(scene), others, settings, watch, progress);
}

std::vector<BakeReport> bake_together(const std::vector<BakeSettings>& settings,
                                      const StageProgress& progress)
{
    std::vector<BakeReport> reports;
    if (settings.size() == 1) {
        reports.push_back(bake(settings.front(), progress));
        return reports;
    }
    Stopwatch watch;
    std::vector<fs::path> inputs;
    for (const BakeSettings& of_file : settings) {
        check_before_work(of_file, false);
        inputs.push_back(of_file.input);
    }
    enter(progress, "read");
    BakeWorld world = read_world(inputs, settings.front().target.normals, settings.front().parts,
                                 settings.front().reading);
    double read_seconds = watch.lap();
    const std::shared_ptr<const Geometry> occluding = world.meshes.front().occluders;
    Occluders occluders(*occluding);
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const Job job{std::make_shared<Mesh>(std::move(world.meshes[i])), &occluders};
        reports.push_back(bake_one(job, settings[i], read_seconds, progress).report);
        read_seconds = 0.0;
    }
    return reports;
}

fs::path output_in_folder(const fs::path& input, const fs::path& folder)
{
    fs::path name = input.filename();
    if (type_of(input) == FileType::stl)
        name.replace_extension(".ply");
    if (type_of(input) == FileType::foreign)
        name.replace_extension(".glb");
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
    if (const auto& ground = settings.ground)
        text += " ground=" + text_of(*ground);
    text += " " + text_of(settings.target) + text_of(settings.parts);
    if (const auto& moment = settings.reading.moment) {
        add(" time=", moment->seconds);
        if (!moment->animation.empty())
            text += " animation=" + moment->animation;
    }
    if (const auto& frame = settings.frame) {
        add(" frame=", frame->centre.x);
        add(":", frame->centre.y);
        add(":", frame->centre.z);
        add(":", frame->diagonal);
        if (is_for_bodies(settings))
            add(" moving=", MovingSettings().tolerance);
    }
    if (settings.subdivide)
        add(" subdivide=", *settings.subdivide);
    if (settings.grid)
        return make_mark("bake", text + " " + text_of(*settings.grid));
    for (const fs::path& other : settings.beside)
        text += " beside=" + other.filename().string();
    if (const auto& texels = settings.texels) {
        text += " " + text_of(*texels);
        return make_mark("bake", text);
    }
    if (!settings.reading.columns.empty()) {
        std::string columns = settings.reading.columns;
        std::ranges::replace(columns, ' ', ',');
        text += " columns=" + columns;
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
    std::vector<fs::path> sources = settings.parts.occluders;
    sources.insert(sources.end(), settings.beside.begin(), settings.beside.end());
    if (settings.texels)
        std::ranges::copy(settings.texels->high, std::back_inserter(sources));
    sources.push_back(settings.input);
    for (std::size_t i = 0, count = sources.size(); i < count; ++i) {
        const FileType type = type_of(sources[i]);
        if (type == FileType::gltf || type == FileType::obj ||
            type == FileType::foreign)  // whose textures' alpha counts too
            std::ranges::copy(sidecars_of(sources[i]), std::back_inserter(sources));
    }
    return std::ranges::all_of(sources, [&](const fs::path& source) {
        std::error_code missing;
        const fs::file_time_type changed = fs::last_write_time(source, missing);
        return !missing && made >= changed;
    });
}

}  // namespace surfelao
