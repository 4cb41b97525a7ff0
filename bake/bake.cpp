#include "bake/bake.h"

#include "bake/peak_memory.h"
#include "engines/threads.h"
#include "files/scene_io.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cctype>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Says which stage begins; the moment at which a job between two stages can be stopped.
void enter(const StageProgress& progress, std::string_view stage)
{
    if (progress && !progress(stage, 0.0))
        throw Cancelled();
}

std::string lower_extension(const fs::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

double mean_occlusion_of(std::span<const Receiver> receivers, std::span<const Occlusion> occlusion)
{
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (receivers[i].normal != glm::vec3(0.0f)) {
            sum += occlusion[i].occlusion;
            ++count;
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

BakeReport bake(const BakeSettings& settings, const StageProgress& progress)
{
    BakeReport report;
    report.settings = settings;
    report.threads = thread_count();
    Stopwatch whole, stage;
    check_output(settings.input, settings.output);

    enter(progress, "read");
    const Scene scene = read_scene(settings.input);
    const Geometry geometry = make_geometry(scene);
    EngineSettings& engine = report.settings.engine;
    engine.definition = definition_of(settings.max_distance, settings.kernel, geometry.frame);
    const std::vector<Receiver> receivers =
        receivers_at_vertices(geometry, engine.definition.offset);
    report.seconds.read = stage.lap();

    enter(progress, "build");
    const Progress solving = [&](double done) { return !progress || progress("solve", done); };
    const Prepared prepared = prepare(geometry, engine);
    const Solution solution = solve(prepared, receivers, engine, solving);

    enter(progress, "write");
    stage.lap();
    write_scene(settings.output, scene, solution.occlusion, {.colors = settings.colors});
    report.seconds.write = stage.lap();

    report.vertices = scene.positions.size();
    report.triangles = scene.triangles.size();
    report.dropped_triangles = geometry.dropped_triangles;
    report.vertices_without_normal = static_cast<std::uint64_t>(
        std::count(geometry.normals.begin(), geometry.normals.end(), glm::vec3(0.0f)));
    report.surfels = prepared.surfel_count();
    report.residual = solution.residual;
    report.mean_occlusion = mean_occlusion_of(receivers, solution.occlusion);
    report.seconds.surfels = prepared.seconds().surfels;
    report.seconds.tree = prepared.seconds().tree;
    report.seconds.solve = solution.seconds;
    report.seconds.total = whole.lap();
    report.peak_rss_bytes = peak_rss_bytes();
    return report;
}

fs::path output_in_folder(const fs::path& input, const fs::path& folder)
{
    fs::path name = input.filename();
    if (lower_extension(input) == ".stl")
        name.replace_extension(".ply");
    return folder / name;
}

bool is_finished(const fs::path& input, const fs::path& output)
{
    std::error_code error;
    const fs::file_time_type made = fs::last_write_time(output, error);
    if (error)
        return false;
    const fs::file_time_type changed = fs::last_write_time(input, error);
    return !error && made >= changed;
}

}  // namespace surfelao
