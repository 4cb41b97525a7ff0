// moving_tables: frames of scenes that move, by masks, disks and rays, against rays in plenty.
//
//   moving_tables MODELS             JSON. MODELS: a folder with mountain.obj, FlightHelmet/ and
//                                    spot.obj; where one is missing, a generated scene stands in
//   moving_tables strip OUT.png      the robot: a row of frames each by masks, by rays that are
//                                    smoothed, in the same time, and by rays in plenty
//
// Per scene: a static world and one body that moves through it. Then a robot of eleven parts beside
// rays, raw and smoothed; disks with and without what they remember; the memory of many frames.

#include "files/scene_io.h"
#include "gpu/context.h"
#include "image/image_file.h"
#include "moving_stage.h"
#include "surfels/stopwatch.h"
#include "tests/scenes.h"
#include "tests/vertex_receivers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 12;
constexpr std::uint32_t kManyRays = 2048;
constexpr std::size_t kSamples = 1000;  // receivers that are held against rays

MovingSettings settings_of(Engine engine, float quality, std::uint32_t rays = 16)
{
    MovingSettings settings;
    settings.quality = engine == Engine::rays ? 0.0f : quality;
    settings.rays = rays;
    return settings;
}

double milliseconds(std::vector<double> seconds)
{
    std::ranges::sort(seconds);
    return 1e3 * seconds[seconds.size() / 2];
}

/// What rays say at some receivers, frame by frame.
struct FrameTruth {
    std::vector<std::size_t> places;
    std::vector<std::vector<float>> frames;
};

FrameTruth truth_of(const MovingStage& stage, int frames)
{
    FrameTruth truth;
    const std::size_t count = stage.receivers.size();
    for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, count / kSamples)) {
        if (stage.receivers[i].normal != glm::vec3(0.0f))
            truth.places.push_back(i);
    }
    MovingScene scene(stage.geometry, stage.body_of_triangle, {.engine = Engine::rays});
    for (int frame = 0; frame < frames; ++frame) {
        stage.place(scene, frame);
        std::vector<Receiver> asked;
        for (const std::size_t i : truth.places)
            asked.push_back(stage.receiver_at(i, frame));
        std::vector<float>& values = truth.frames.emplace_back();
        for (const Occlusion& answer :
             scene.solve(asked, settings_of(Engine::rays, 0.0f, kManyRays)).occlusion)
            values.push_back(answer.occlusion);
    }
    return truth;
}

/// Errors of frames, and what changes from one to the next beside what changes truly.
class FrameErrors {
public:
    FrameErrors(const MovingStage& stage, const FrameTruth& truth) : stage_(stage), truth_(truth) {}

    void add(int frame, const std::vector<Occlusion>& answers)
    {
        std::vector<double> errors;
        for (std::size_t k = 0; k < truth_.places.size(); ++k) {
            errors.push_back(double{answers[truth_.places[k]].occlusion} - truth_.frames[frame][k]);
            squares_ += errors.back() * errors.back();
            ++count_;
        }
        for (std::size_t k = 0; k < before_.size(); ++k) {
            if (!stage_.is_static(truth_.places[k]))
                continue;
            const double change = std::abs(errors[k] - before_[k]);
            changes_ += change * change;
            largest_ = std::max(largest_, change);
            ++changed_;
        }
        before_ = std::move(errors);
    }

    double rmse() const { return std::sqrt(squares_ / static_cast<double>(std::max(1, count_))); }
    double spurious() const
    {
        return std::sqrt(changes_ / static_cast<double>(std::max(1, changed_)));
    }
    double largest() const { return largest_; }

private:
    const MovingStage& stage_;
    const FrameTruth& truth_;
    std::vector<double> before_;
    double squares_ = 0.0, changes_ = 0.0, largest_ = 0.0;
    int count_ = 0, changed_ = 0;
};

/// Static receivers that no body nears by more than the tolerance, now or a frame ago, and yet have
/// other bytes.
std::size_t changed_untouched(const MovingStage& stage, int frame,
                              const std::vector<Occlusion>& before,
                              const std::vector<Occlusion>& now)
{
    std::size_t changed = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (stage.is_static(i) && !(now[i] == before[i]) && stage.is_far(i, frame) &&
            stage.is_far(i, frame - 1))
            ++changed;
    }
    return changed;
}

struct FrameRow {
    std::vector<double> place, tree, solve, total, solved;
    std::size_t untouched = 0;  ///< with other bytes
};

void print_frames(const char* name, const FrameRow& row, const FrameErrors& errors)
{
    std::printf(
        "\"%s\": {\"place_ms\": %.3f, \"tree_ms\": %.3f, \"solve_ms\": %.3f, \"frame_ms\": %.3f, "
        "\"solved\": %.0f, \"rmse\": %.6f, \"spurious\": %.6f, \"largest\": %.5f, "
        "\"untouched_changed\": %zu}",
        name, milliseconds(row.place), milliseconds(row.tree), milliseconds(row.solve),
        milliseconds(row.total), milliseconds(row.solved) * 1e-3, errors.rmse(), errors.spurious(),
        errors.largest(), row.untouched);
    std::fflush(stdout);
}

/// smoothing: passes of smooth() over each frame, whose time counts.
void measure_moving(const char* name, const MovingStage& stage, const FrameTruth& truth,
                    Engine engine, const MovingSettings& settings, int smoothing = 0)
{
    MovingScene scene(stage.geometry, stage.body_of_triangle, {.engine = engine});
    MovingReceivers receivers(scene, stage.receivers, stage.body_of_receiver, settings);
    FrameRow row;
    FrameErrors errors(stage, truth);
    std::vector<Occlusion> before;
    for (int frame = 0; frame < static_cast<int>(truth.frames.size()); ++frame) {
        stage.place(scene, frame);
        Stopwatch watch;
        const FrameReport report = receivers.solve();
        std::vector<Occlusion> answers = receivers.occlusion();
        if (smoothing > 0)
            stage.smooth(answers, smoothing);
        const double seconds = watch.lap();
        errors.add(frame, answers);
        if (frame > 0) {  // the first one solves all
            row.place.push_back(report.place);
            row.tree.push_back(report.tree);
            row.solve.push_back(report.solve);
            row.total.push_back(seconds);
            row.solved.push_back(static_cast<double>(report.solved));
            row.untouched += changed_untouched(stage, frame, before, answers);
        }
        before = std::move(answers);
    }
    print_frames(name, row, errors);
}

/// The geometry of each frame prepared and solved anew.
void measure_rebuilt(const char* name, const MovingStage& stage, const FrameTruth& truth,
                     Engine engine, const MovingSettings& settings)
{
    FrameRow row;
    FrameErrors errors(stage, truth);
    std::vector<Occlusion> before;
    for (int frame = 0; frame < static_cast<int>(truth.frames.size()); ++frame) {
        Stopwatch watch;
        const Geometry geometry = stage.geometry_at(frame);
        std::vector<Receiver> asked;
        for (std::size_t i = 0; i < stage.receivers.size(); ++i)
            asked.push_back(stage.receiver_at(i, frame));
        const double place = watch.lap();
        const Prepared prepared = prepare(geometry, {.engine = engine});
        const double tree = watch.lap();
        std::vector<Occlusion> answers = solve(prepared, asked, settings).occlusion;
        const double solving = watch.lap();
        errors.add(frame, answers);
        if (frame > 0) {
            row.place.push_back(place);
            row.tree.push_back(tree);
            row.solve.push_back(solving);
            row.total.push_back(place + tree + solving);
            row.solved.push_back(static_cast<double>(answers.size()));
            row.untouched += changed_untouched(stage, frame, before, answers);
        }
        before = std::move(answers);
    }
    print_frames(name, row, errors);
}

void print_scene(const MovingStage& stage)
{
    const FrameTruth truth = truth_of(stage, kFrames);
    std::printf("\n {\"name\": \"%s\", \"vertices\": %zu, \"triangles\": %zu, \"frames\": %d,\n  ",
                stage.name.c_str(), stage.receivers.size(), stage.geometry.triangles.size(),
                kFrames);
    for (const float quality : {kDraft, kGood}) {
        const MovingSettings settings = settings_of(Engine::masks, quality);
        const std::string name = quality == kDraft ? "draft" : "good";
        measure_moving(name.c_str(), stage, truth, Engine::masks, settings);
        std::printf(",\n  ");
        measure_rebuilt((name + "_rebuilt").c_str(), stage, truth, Engine::masks, settings);
        std::printf(",\n  ");
    }
    const MovingSettings disks = settings_of(Engine::disks, kGood);
    measure_moving("disks", stage, truth, Engine::disks, disks);
    std::printf(",\n  ");
    measure_rebuilt("disks_rebuilt", stage, truth, Engine::disks, disks);
    std::printf("}");
}

// ---- the robot

constexpr int kSmoothing = 3;  // more passes blur more than they calm

void print_robot()
{
    const MovingStage stage = robot_stage();
    const FrameTruth truth = truth_of(stage, kFrames);
    std::printf(
        "\"robot\": {\"parts\": %zu, \"vertices\": %zu, \"triangles\": %zu, "
        "\"smoothing\": %d,\n  ",
        stage.bodies() - 1, stage.receivers.size(), stage.geometry.triangles.size(), kSmoothing);
    measure_moving("draft", stage, truth, Engine::masks, settings_of(Engine::masks, kDraft));
    std::printf(",\n  ");
    measure_moving("good", stage, truth, Engine::masks, settings_of(Engine::masks, kGood));
    std::printf(",\n  ");
    measure_rebuilt("draft_rebuilt", stage, truth, Engine::masks,
                    settings_of(Engine::masks, kDraft));
    for (const std::uint32_t rays : {4u, 8u, 16u, 32u, 64u}) {
        const MovingSettings settings = settings_of(Engine::rays, 0.0f, rays);
        std::printf(",\n  ");
        measure_moving(("rays_" + std::to_string(rays)).c_str(), stage, truth, Engine::rays,
                       settings);
        std::printf(",\n  ");
        measure_moving(("smooth_" + std::to_string(rays)).c_str(), stage, truth, Engine::rays,
                       settings, kSmoothing);
    }
    std::printf("},\n");
}

// ---- memory

double resident_mib()
{
    std::ifstream file("/proc/self/statm");
    double all = 0.0, resident = 0.0;
    file >> all >> resident;
    return resident * 4096.0 / (1 << 20);
}

void print_memory()
{
    constexpr int kMany = 1000, kWarm = 100;
    std::printf("\"memory\": {\"frames\": %d, \"from\": %d", kMany, kWarm);
    const MovingStage stage = small_stage();
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays}) {
        MovingScene scene(stage.geometry, stage.body_of_triangle, {.engine = engine});
        MovingReceivers receivers(scene, stage.receivers, stage.body_of_receiver,
                                  settings_of(engine, kDraft));
        double warm = 0.0;
        for (int frame = 0; frame < kMany; ++frame) {
            if (frame == kWarm)
                warm = resident_mib();
            stage.place(scene, frame % kFrames);
            receivers.solve();
        }
        std::printf(", \"%s\": {\"mib\": %.1f, \"grown_mib\": %.2f}", name_of(engine).c_str(),
                    resident_mib(), resident_mib() - warm);
    }
    std::printf("}");
}

// ---- disks on the GPU

/// A wavy grid of Bunnell's and Engleson's largest size in software OpenGL: the first solve, and
/// later ones, which start from what it has corrected.
void print_gpu()
{
    constexpr int kCells = 128, kSolves = 7;
    const Geometry geometry = make_geometry(scenes::height_field(
        kCells, [](double x, double y) { return 0.1 * std::sin(12.0 * x) * std::cos(9.0 * y); }));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    const GlContext context = GlContext::create(GlBackend::osmesa);
    std::vector<double> first, later;
    for (int round = 0; round <= 2; ++round) {
        const Prepared prepared = prepare(
            geometry, {.engine = Engine::disks, .device = Device::gpu, .context = &context});
        first.push_back(solve(prepared, receivers).seconds);
        for (int k = 0; k < kSolves; ++k)
            later.push_back(solve(prepared, receivers).seconds);
    }
    first.erase(first.begin());  // compiles the shaders
    std::printf(",\n\"gpu\": {\"vertices\": %zu, \"first_ms\": %.1f, \"later_ms\": %.1f}",
                receivers.size(), milliseconds(first), milliseconds(later));
}

// ---- all

/// A model, or what stands in for it.
Scene scene_or(const fs::path& path, const Scene& generated, bool& is_generated)
{
    if (fs::exists(path))
        return read_scene(path);
    std::fprintf(stderr, "moving_tables: no %s: a generated scene stands in\n",
                 path.filename().string().c_str());
    is_generated = true;
    return generated;
}

void print_tables(const fs::path& models)
{
    bool generated = false;
    const Scene body = scene_or(models / "spot.obj", generated_body(), generated);
    std::printf("{\"rays\": %u, \"samples\": %zu,\n\"scenes\": [", kManyRays, kSamples);
    print_scene(crossing_stage(
        "mountain", scene_or(models / "mountain.obj", generated_ground(), generated), body));
    std::printf(",");
    print_scene(crossing_stage(
        "FlightHelmet",
        scene_or(models / "FlightHelmet" / "FlightHelmet.gltf", generated_scan(), generated),
        body));
    std::printf(",");
    print_scene(crossing_stage("room", generated_room(), body));
    std::printf("],\n");
    print_robot();
    print_memory();
    print_gpu();
    std::printf(",\n\"generated\": %s}\n", generated ? "true" : "false");
}

/// Rows of frames: masks, smoothed rays, rays in plenty.
void draw_strip(const fs::path& file)
{
    const MovingStage stage = robot_stage();
    constexpr int kShown = 5, kWidth = 150, kHeight = 220;
    constexpr std::uint32_t kPlenty = 256;
    Image image(kShown * kWidth, 3 * kHeight, glm::vec4(1.0f));
    for (int row = 0; row < 3; ++row) {
        const Engine engine = row == 0 ? Engine::masks : Engine::rays;
        MovingScene scene(stage.geometry, stage.body_of_triangle, {.engine = engine});
        MovingReceivers receivers(scene, stage.receivers, stage.body_of_receiver,
                                  settings_of(engine, kDraft, row == 1 ? 16 : kPlenty));
        for (int frame = 0; frame < kShown; ++frame) {
            stage.place(scene, frame);
            receivers.solve();
            std::vector<Occlusion> answers = receivers.occlusion();
            if (row == 1)
                stage.smooth(answers, kSmoothing);
            stage.draw(answers, frame, {frame * kWidth, row * kHeight}, {kWidth, kHeight}, image);
        }
    }
    write_image(file, image);
}

int run(int count, char** words)
{
    if (count == 3 && std::string_view(words[1]) == "strip") {
        draw_strip(words[2]);
        return 0;
    }
    if (count != 2) {
        std::fprintf(stderr, "usage: moving_tables MODELS | strip OUT.png\n");
        return 2;
    }
    print_tables(words[1]);
    return 0;
}

}  // namespace
}  // namespace surfelao

int main(int count, char** words)
{
    try {
        return surfelao::run(count, words);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "moving_tables: %s\n", error.what());
        return 1;
    }
}
