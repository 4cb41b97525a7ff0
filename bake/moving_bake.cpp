#include "bake/moving_bake.h"

#include "bake/moving_solver.h"
#include "bake/moving_world.h"
#include "bake/notes.h"
#include "bake/peak_memory.h"
#include "bake/point_job.h"
#include "engines/threads.h"
#include "files/file_type.h"
#include "files/scene_io.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

class FrameBaker {
public:
    FrameBaker(std::span<const BakeSettings> frames, const StageProgress& progress)
        : settings_(frames.front()),
          progress_(progress),
          world_(settings_.input, seconds_of(frames), settings_.target, settings_.parts,
                 settings_.reading)
    {
        check_points(settings_, world_.scene());
        settings_.frame = world_.frame();
        settings_.engine.definition =
            world_.definition_for(settings_.max_distance, settings_.kernel, settings_.ground,
                                  largest_offset_of(settings_.target, world_.frame()));
    }

    /// As the mark of a frame's file has them.
    BakeSettings settings_for(const BakeSettings& frame) const
    {
        BakeSettings own = settings_;
        own.output = frame.output;
        own.reading = frame.reading;
        return own;
    }

    BakeReport bake(const BakeSettings& frame)
    {
        BakeReport report;
        report.settings = settings_for(frame);
        report.threads = thread_count();
        Stopwatch whole, stage;
        enter("place");
        const bool is_first = !solver_;
        if (is_first) {
            solver_.emplace(world_, settings_.engine);
            report.seconds.tree = stage.lap();
        }
        MotionReport& motion = report.motion.emplace();
        world_.pose(frame.reading.moment->seconds);
        motion.pose = stage.lap();
        solver_->place();
        motion.place = stage.lap();
        enter("solve");
        const FrameReport solved =
            solver_->solve([&](double done) { return !progress_ || progress_("solve", done); });
        motion.place += solved.place;
        motion.solved = solved.solved;
        motion.bound = solved.bound;
        report.seconds.tree += solved.tree;
        report.seconds.solve = solved.solve;
        report.residual = solved.residual;
        stage.lap();
        const std::vector<Occlusion>& values = solver_->values_of(solver_->answers());
        report.misfit = world_.misfit(solver_->answers(), values);
        report.seconds.fit = stage.lap();
        if (settings_.check > 0)
            check(values, report);
        report.seconds.check = stage.lap();
        enter("write");
        report.notes = is_first ? first_notes(values, report.misfit) : world_.scene().notes;
        write(values, report);
        report.seconds.write = stage.lap();
        fill(values, report);
        report.seconds.total = whole.lap();
        return report;
    }

private:
    static std::vector<double> seconds_of(std::span<const BakeSettings> frames)
    {
        std::vector<double> seconds;
        for (const BakeSettings& frame : frames)
            seconds.push_back(frame.reading.moment->seconds);
        return seconds;
    }

    /// The moment at which a sequence between two stages can be stopped.
    void enter(std::string_view stage) const
    {
        if (progress_ && !progress_(stage, 0.0))
            throw Cancelled();
    }

    void check(const std::vector<Occlusion>& values, BakeReport& report) const
    {
        enter("check");
        const Geometry surface = world_.surface_now(), occluders = world_.occluders_now();
        const std::vector<Occlusion> shown_values = world_.on_surface(values);
        const Shown shown = [&](const SurfacePoint& point) {
            return displayed(surface, shown_values, point);
        };
        const std::vector<double> density(surface.triangles.size(), 1.0);
        ErrorCheck check(
            surface, density,
            [&](std::span<const SurfacePoint> points) { return world_.receivers_now(points); },
            occluders, settings_.check);
        check.trace(settings_.engine.definition, shown,
                    [&](double done) { return !progress_ || progress_("check", done); });
        report.error = check.error_of(shown);
    }

    void write(const std::vector<Occlusion>& values, BakeReport& report) const
    {
        const BakeSettings& settings = report.settings;
        const WriteOptions options{.colors = settings.colors,
                                   .encoding = settings.encoding,
                                   .mark = mark_of(settings),
                                   .unbaked = world_.unbaked()};
        const FileType type = type_of(settings.output);
        const bool is_own = type == FileType::gltf || type == FileType::glb;
        const std::vector<std::string> written =
            is_own ? write_scene(settings.output, read_scene(settings.input, settings.reading),
                                 values, options)
                   : write_scene(settings.output, world_.scene(), values, options);
        report.notes.insert(report.notes.end(), written.begin(), written.end());
    }

    /// What the user should know of the whole sequence, told with one frame of it.
    std::vector<std::string> first_notes(const std::vector<Occlusion>& values,
                                         const std::optional<Misfit>& misfit) const
    {
        const Mesh mesh =
            mesh_of(Scene(world_.scene()), read_others(settings_.parts, settings_.reading),
                    settings_.target.normals, settings_.parts, world_.frame());
        return notes_of(
            {mesh, analyse_topology(mesh.geometry), settings_.engine.definition, values, misfit});
    }

    void fill(const std::vector<Occlusion>& values, BakeReport& report) const
    {
        report.vertices = world_.scene().positions.size();
        report.triangles = world_.scene().triangles.size();
        report.baked_triangles = world_.triangle_count();
        report.occluding_triangles = world_.occluders().triangles.size();
        report.receivers = world_.receiver_count();
        const SurfaceCounts counts = world_.counts();
        report.dropped_triangles = counts.dropped_triangles;
        report.vertices_without_normal = counts.vertices_without_normal;
        report.corners_from_file = counts.corners_from_file;
        report.replaced_corners = counts.replaced_corners;
        report.mean_occlusion = world_.mean_occlusion_of(values);
        if (report.settings.engine.definition.ground)
            report.ground = text_of(*report.settings.engine.definition.ground, world_.frame());
        report.peak_rss_bytes = peak_rss_bytes();
    }

    BakeSettings settings_;
    const StageProgress& progress_;
    MovingWorld world_;
    std::optional<MovingSolver> solver_;
};

}  // namespace

bool is_for_bodies(const BakeSettings& settings)
{
    return !settings.texels && !settings.error && !settings.share && !settings.subdivide &&
           settings.beside.empty() && settings.engine.device == Device::cpu;
}

void bake_frames(std::span<const BakeSettings> frames, bool resume, const FrameDone& done,
                 const StageProgress& progress)
{
    for (const BakeSettings& frame : frames)
        check_output(frame.input, frame.output);
    if (progress && !progress("read", 0.0))
        throw Cancelled();
    Stopwatch watch;
    FrameBaker baker(frames, progress);
    double read = watch.lap();
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (resume && is_finished(baker.settings_for(frames[i]))) {
            done(i, std::nullopt);
            continue;
        }
        BakeReport report = baker.bake(frames[i]);
        report.seconds.read = std::exchange(read, 0.0);
        report.seconds.total += report.seconds.read;
        done(i, std::move(report));
    }
}

}  // namespace surfelao
