#include "pixels/pixel_compare.h"

#include "engines/threads.h"
#include "reference/reference_cache.h"
#include "surfels/errors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

/// A pass of a few milliseconds is drawn again within its round for so many seconds.
constexpr double kPassRound = 0.1;
constexpr int kMostDrawings = 100;

constexpr double kPercent = 100.0;

/// Who answers for one scene.
struct Answerers {
    Answerers(const Mesh& mesh, const GlContext& gl)
        : context(gl),
          drawn(gl, mesh.geometry, mesh.surface),
          screen(gl),
          grids(gl),
          on_cpu(mesh.occluding()),
          on_gpu(mesh.occluding())
    {
    }
    Occluders& occluders_for(const PixelEngine& engine)
    {
        const auto* settings = std::get_if<EngineSettings>(&engine);
        return settings != nullptr && settings->device == Device::gpu ? on_gpu : on_cpu;
    }

    const GlContext& context;
    DrawnMesh drawn;
    ScreenSpace screen;
    GridPass grids;
    Occluders on_cpu, on_gpu;
};

/// Names the stages of a comparison.
class PixelStages {
public:
    explicit PixelStages(const StageProgress& progress) : progress_(progress) {}

    /// Throws Cancelled.
    Progress operator()(const std::string& name) const
    {
        if (!progress_)
            return {};
        if (!progress_(name, 0.0))
            throw Cancelled();
        return [this, name](double done) { return progress_(name, done); };
    }

private:
    const StageProgress& progress_;
};

/// What one camera sees, and what is right there.
struct PixelQuestion {
    const PixelView& view;
    const Reference& reference;
    const Definition& definition;
    bool pictures = false;
};

PixelError mean_of(std::span<const PixelError> errors)
{
    PixelError mean;
    for (const PixelError& error : errors) {
        mean.rmse += error.rmse;
        mean.rmse_whole += error.rmse_whole;
        mean.bias += error.bias;
        mean.p95 += error.p95;
        mean.max = std::max(mean.max, error.max);
    }
    const double count = static_cast<double>(errors.size());
    for (double* sum : {&mean.rmse, &mean.rmse_whole, &mean.bias, &mean.p95})
        *sum /= count;
    return mean;
}

void add_means(PixelComparison& comparison)
{
    const std::size_t engines = comparison.rows.size() / comparison.cameras.size();
    for (std::size_t e = 0; e < engines; ++e) {
        PixelMean& mean = comparison.means.emplace_back();
        std::vector<PixelError> errors;
        for (std::size_t c = 0; c < comparison.cameras.size(); ++c) {
            const PixelRow& row = comparison.rows[c * engines + e];
            mean.engine = row.engine;
            mean.clock = row.clock;
            mean.ms += row.ms / static_cast<double>(comparison.cameras.size());
            errors.push_back(row.error);
        }
        mean.error = mean_of(errors);
    }
}

/// Median seconds of a round's drawings of one pass.
PassTime time_pass(const PixelQuestion& question, ScreenSpace& screen,
                   const ScreenSettings& settings)
{
    const GBuffer& seen = question.view.g_buffer();
    const Framebuffer target = screen.make_target(seen);
    const PassTime first = screen.time(seen, settings, question.definition, target, 1);
    const double fits = std::min(kPassRound / std::max(first.seconds, 1e-9), 1.0 * kMostDrawings);
    if (fits < 2.0)
        return first;
    return screen.time(seen, settings, question.definition, target, static_cast<int>(fits));
}

/// One round of one row: its seconds. The first one is judged.
double run_pixel_round(const PixelQuestion& question, Answerers& answerers, bool is_first,
                       PixelRow& row, const Progress& progress)
{
    const auto* pass = std::get_if<ScreenSettings>(&row.engine);
    double seconds = 0.0;
    if (pass == nullptr || is_first) {
        const auto* grids = std::get_if<GridPixels>(&row.engine);
        const PixelAnswer result =
            grids != nullptr
                ? answer(question.view, answerers.grids, *grids, question.definition, progress)
                : answer(question.view, answerers.occluders_for(row.engine), answerers.screen,
                         row.engine, question.definition, progress);
        seconds = result.seconds;
        row.clock = "steady_clock";
        if (is_first) {
            const SeenPixels& seen = question.view.seen();
            const std::size_t pixels =
                static_cast<std::size_t>(seen.width) * static_cast<std::size_t>(seen.height);
            row.error = pixel_error(result.values, question.reference.occlusion,
                                    question.reference.noise, pixels);
            if (question.pictures) {
                row.picture_png = png_of(occlusion_picture(seen, result.values));
                row.difference_png =
                    png_of(difference_picture(seen, result.values, question.reference.occlusion));
            }
        }
    }
    if (pass != nullptr) {
        const PassTime time = time_pass(question, answerers.screen, *pass);
        row.clock = time.clock;
        seconds = time.seconds;
    }
    return seconds;
}

/// All rows of one camera.
void run_camera(const PixelCompareSettings& settings, const PixelQuestion& question,
                Answerers& answerers, const PixelStages& stage, PixelComparison& comparison)
{
    const std::size_t camera = comparison.cameras.size() - 1;
    const std::string of_all = " " + std::to_string(camera + 1);
    std::vector<PixelRow> rows;
    for (const PixelEngine& engine : settings.engines) {
        PixelRow& row = rows.emplace_back();
        row.engine = engine;
        row.camera = camera;
        if (auto* scene = std::get_if<EngineSettings>(&row.engine); scene && !scene->context)
            scene->context = &answerers.context;
    }
    std::vector<std::vector<double>> seconds(rows.size());
    for (int round = 0; round < settings.rounds; ++round) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::string name = name_of(rows[i].engine) + " " + setting_of(rows[i].engine);
            seconds[i].push_back(run_pixel_round(question, answerers, round == 0, rows[i],
                                                 stage(name + ", camera" + of_all)));
        }
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].ms = 1e3 * quantile(std::move(seconds[i]), 0.5);
        if (auto* scene = std::get_if<EngineSettings>(&rows[i].engine))
            scene->context = nullptr;  // it does not outlive this
        comparison.rows.push_back(std::move(rows[i]));
    }
}

void look_from(const NamedCamera& from, const Mesh& mesh, const PixelCompareSettings& settings,
               Answerers& answerers, const PixelStages& stage, PixelComparison& comparison)
{
    const std::string number = std::to_string(comparison.cameras.size() + 1);
    static_cast<void>(stage("camera " + number));
    const PixelView view(answerers.context, mesh, answerers.drawn,
                         view_of(from.camera, settings.size.width, settings.size.height),
                         settings.size, offset_of(settings.target, mesh.geometry.frame),
                         settings.guard);
    const SeenPixels& seen = view.seen();
    if (seen.pixels.empty())
        throw InputError("camera " + from.text + ": nothing of the scene is seen");
    const Reference reference = trace_reference(mesh.occluding(), seen.receivers,
                                                {.definition = comparison.definition,
                                                 .rays = settings.reference_rays,
                                                 .use_cache = settings.use_cache,
                                                 .find_ill_defined = false},
                                                stage("rays, camera " + number));
    answerers.context.make_current();

    PixelCamera& camera = comparison.cameras.emplace_back();
    camera.from = from;
    camera.surface_pixels = seen.pixels.size();
    camera.share = static_cast<double>(seen.pixels.size()) /
                   (static_cast<double>(seen.width) * static_cast<double>(seen.height));
    camera.noise = kPercent * reference.noise;
    camera.reference_from_cache = reference.from_cache;
    double sum = 0.0;
    for (const Occlusion& value : reference.occlusion)
        sum += static_cast<double>(value.occlusion);
    camera.mean_occlusion = sum / static_cast<double>(seen.pixels.size());
    if (settings.pictures)
        camera.reference_png = png_of(occlusion_picture(seen, reference.occlusion));
    run_camera(settings, {view, reference, comparison.definition, settings.pictures}, answerers,
               stage, comparison);
}

void check_pixel_settings(const PixelCompareSettings& settings)
{
    require(!settings.engines.empty(), "a comparison needs engines");
    require(settings.rounds >= 1, "rounds must be at least 1");
    require(settings.views >= 1, "views must be at least 1");
    for (const PixelEngine& engine : settings.engines) {
        if (const auto* scene = std::get_if<EngineSettings>(&engine))
            check_settings(*scene, *scene);
        else if (const auto* screen = std::get_if<ScreenSettings>(&engine))
            check_settings(*screen);
        else
            check_settings(std::get<GridPixels>(engine).rest, std::get<GridPixels>(engine).rest);
    }
}

}  // namespace

PixelError pixel_error(std::span<const Occlusion> answers, std::span<const Occlusion> reference,
                       double noise, std::size_t picture_pixels)
{
    const ErrorStatistics found = error_statistics(answers, reference, noise);
    const double share = static_cast<double>(answers.size()) /
                         static_cast<double>(std::max<std::size_t>(1, picture_pixels));
    return {.rmse = kPercent * found.rmse,
            .rmse_whole = kPercent * found.rmse * std::sqrt(share),
            .bias = kPercent * found.bias,
            .p95 = kPercent * found.p95,
            .max = kPercent * found.max};
}

std::size_t best_of(std::span<const PixelMean> means)
{
    const auto best =
        std::ranges::min_element(means, {}, [](const PixelMean& mean) { return mean.error.rmse; });
    return static_cast<std::size_t>(best - means.begin());
}

PixelComparison compare_pixels(const Mesh& mesh, const PixelCompareSettings& settings,
                               const StageProgress& progress)
{
    check_pixel_settings(settings);
    const PixelStages stage(progress);
    const Frame& frame = mesh.geometry.frame;
    PixelComparison comparison;
    comparison.input = settings.input;
    comparison.triangles = mesh.scene.triangles.size();
    comparison.size = settings.size;
    comparison.guard = settings.guard;
    comparison.threads = thread_count();
    comparison.rounds = settings.rounds;
    comparison.reference_rays = settings.reference_rays;
    comparison.diagonal = frame.diagonal;
    comparison.sweep = settings.sweep;
    comparison.definition = definition_of(settings.max_distance, settings.kernel, frame);
    comparison.definition.ground = ground_of(settings.ground, {mesh.geometry, mesh.occluding()},
                                             largest_offset_of(settings.target, frame));
    if (comparison.definition.ground)
        comparison.ground = text_of(*comparison.definition.ground, frame);

    const float aspect =
        static_cast<float>(settings.size.width) / static_cast<float>(settings.size.height);
    const std::vector<glm::vec3> framed = framed_points(mesh.geometry);
    const CameraWishes wishes{.points = framed,
                              .frame_centre = frame.centre,
                              .frame_diagonal = frame.diagonal,
                              .up = settings.up,
                              .aspect = aspect};
    const std::vector<NamedCamera> cameras = settings.cameras.empty()
                                                 ? spread_cameras(settings.views, wishes)
                                                 : cameras_of(settings.cameras, wishes);
    const GlContext context = GlContext::create(settings.backend);
    comparison.renderer = context.info().renderer;
    comparison.software = context.info().software;
    Answerers answerers(mesh, context);
    for (const NamedCamera& camera : cameras)
        look_from(camera, mesh, settings, answerers, stage, comparison);
    add_means(comparison);
    return comparison;
}

PixelComparison compare_pixels(const PixelCompareSettings& settings, const StageProgress& progress)
{
    static_cast<void>(PixelStages(progress)("read"));
    Scene scene = read_scene(settings.input, settings.reading);
    if (scene.triangles.empty())
        throw InputError(scene.name + ": has points only, no faces: --at points");
    const std::vector<Scene> others = read_others(settings.parts, settings.reading);
    const Mesh mesh = mesh_of(std::move(scene), others, settings.target.normals, settings.parts);
    PixelCompareSettings with_grids = settings;
    std::shared_ptr<GridWorld> world;
    for (PixelEngine& engine : with_grids.engines) {
        auto* grids = std::get_if<GridPixels>(&engine);
        if (grids == nullptr)
            continue;
        if (!world)
            world = grid_world_of(mesh, others, settings.parts, settings.grids,
                                  settings.reading.moment);
        grids->world = world;
    }
    return compare_pixels(mesh, with_grids, progress);
}

}  // namespace surfelao
