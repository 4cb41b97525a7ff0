// cube_tables: what pixels read from cube maps, against rays at the same pixels.
//
//   cube_tables MODEL ring|inside [PIXELS RAYS]
//                               JSON: ring = a body from outside, maps on a sphere of .7 diagonals;
//                               inside = a room with z upwards, from inside
//
// Rows: placements x who answers the texels (masks, horizons), and masks at the pixels themselves.
// All measure occlusion within .15 diagonals. Then what a moving camera changes at places that stay
// where they are: with maps that fade and with the nearest ones taken as they are.

#include "../pixels/cube_twin.h"
#include "bake/surface_error.h"
#include "files/scene_io.h"
#include "pixels/cube_answer.h"
#include "pixels/cube_placement.h"
#include "reference/closest_hit.h"
#include "reference/rays.h"
#include "surfels/stopwatch.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

constexpr float kReach = 0.15f;  // diagonals
constexpr int kRounds = 5;
constexpr int kFrames = 1000;  // of a turn
constexpr std::uint64_t kPlaces = 1000;
constexpr int kFewMaps = 3;  // of the moving camera: so few that they come and go

struct Benchmark {
    Benchmark(const char* file, bool from_inside)
        : inside(from_inside),
          mesh(make_mesh(read_scene(file))),
          context(GlContext::create(GlBackend::osmesa)),
          drawn(context, mesh.geometry, mesh.surface),
          occluders(mesh.geometry),
          screen(context)
    {
    }
    CubeWorld world() { return {context, mesh, drawn, occluders, screen}; }

    bool inside;
    Mesh mesh;
    GlContext context;
    DrawnMesh drawn;
    Occluders occluders;
    ScreenSpace screen;
};

Camera camera_of(const Benchmark& bench, PictureSize size)
{
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    if (!bench.inside)
        return frame_points(bench.mesh.geometry.positions, UpAxis::y, aspect);
    Camera camera;  // near a corner, towards the middle
    camera.up = up_direction(UpAxis::z);
    camera.eye = {-0.3f, -0.2f, 0.0f};
    camera.target = {0.1f, 0.05f, -0.02f};
    camera.fovy_deg = 60.0f;
    return camera;
}

/// Names of placements with their centres.
struct NamedPlaces {
    std::string name;
    std::vector<glm::vec3> centres;
    double seconds = 0.0;
};

std::vector<NamedPlaces> placements_of(const Benchmark& bench)
{
    std::vector<NamedPlaces> all;
    const auto ring = [](int count) {
        std::vector<glm::vec3> centres;
        for (int k = 0; k < count; ++k) {
            const float z =
                1.0f - (2.0f * static_cast<float>(k) + 1.0f) / static_cast<float>(count);
            const float turn = 2.39996f * static_cast<float>(k), r = std::sqrt(1.0f - z * z);
            centres.push_back(0.7f * glm::vec3(r * std::cos(turn), 0.9f * z, r * std::sin(turn)));
        }
        return centres;
    };
    if (bench.inside) {
        all.push_back({"middle", {{0.03f, 0.05f, -0.02f}}});
    } else {
        all.push_back({"sphere of 4", ring(4)});
        all.push_back({"sphere of 12", ring(12)});
    }
    Stopwatch watch;
    const CubePlacement placed = place_cube_maps(bench.mesh);
    all.push_back({"auto", placed.centres, watch.lap()});
    return all;
}

/// Some of a view's pixels and what rays say there.
struct PixelTruth {
    std::vector<std::size_t> pixels;  ///< of the seen ones
    std::vector<Occlusion> values;
};

PixelTruth truth_at(const Benchmark& bench, const PixelView& view, std::size_t count,
                    std::uint32_t rays)
{
    PixelTruth truth;
    std::vector<Receiver> receivers;
    const std::size_t seen = view.seen().pixels.size();
    for (std::size_t i = 0; i < seen; i += std::max<std::size_t>(1, seen / count)) {
        truth.pixels.push_back(i);
        receivers.push_back(view.seen().receivers[i]);
    }
    RayOptions options;
    options.rays = rays;
    options.definition.max_distance = kReach;
    truth.values =
        trace_occlusion(RayScene(bench.mesh.geometry, RayScene::Build::robust), receivers, options);
    return truth;
}

/// Errors where `counts`.
template <class Value, class Counts>
ErrorStatistics errors_of(const PixelTruth& truth, const Value& value, const Counts& counts)
{
    std::vector<Occlusion> answers, references;
    for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
        if (!counts(truth.pixels[k]))
            continue;
        answers.push_back({value(truth.pixels[k]), glm::vec3(0.0f)});
        references.push_back({truth.values[k].occlusion, glm::vec3(0.0f)});
    }
    return error_statistics(answers, references);
}

double median(std::vector<double> values)
{
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void print_row(Benchmark& bench, const NamedPlaces& places, const char* engine_name,
               const CubeSettings& settings, const PixelView& view, const PixelTruth& truth)
{
    CubeProjector projector(bench.context);
    CubeSeconds seconds;
    for (const glm::vec3 centre : places.centres)
        projector.add(make_cube_map(bench.world(), centre, settings, seconds));
    std::size_t texels = 0;
    for (const CubeMap& map : projector.maps())
        texels += static_cast<std::size_t>(std::ranges::count_if(
            map.distances, [](float distance) { return distance < kNothingThere; }));
    CubeAnswer answer = answer_from_maps(view, projector);
    const auto shown = [&](std::size_t i) { return answer.occlusion[i]; };
    const ErrorStatistics covered =
        errors_of(truth, shown, [&](std::size_t i) { return answer.hole[i] == 0; });
    const auto all = [](std::size_t) { return true; };
    const double white = errors_of(truth, shown, all).rmse;
    solve_holes(answer, view, bench.world(), settings);
    const double solved = errors_of(truth, shown, all).rmse;
    std::printf(
        "\n {\"placement\": \"%s\", \"engine\": \"%s\", \"maps\": %zu, \"size\": %d, "
        "\"texels\": %zu, \"mb\": %.2f, \"placement_s\": %.3f, \"draw_s\": %.3f, "
        "\"solve_s\": %.3f, \"coverage\": %.5f, \"rmse\": %.5f, \"bias\": %.5f, \"p95\": %.5f, "
        "\"max\": %.4f, \"rmse_white\": %.5f, \"rmse_solved\": %.5f, \"holes_s\": %.3f}",
        places.name.c_str(), engine_name, places.centres.size(), settings.size, texels,
        static_cast<double>(projector.bytes()) / 1e6, places.seconds, seconds.draw, seconds.solve,
        answer.coverage(), covered.rmse, covered.bias, covered.p95, covered.max, white, solved,
        answer.holes_s);
    std::fflush(stdout);
}

/// Masks at the pixels themselves.
void print_direct(Benchmark& bench, const CubeSettings& settings, const PixelView& view,
                  const PixelTruth& truth)
{
    std::vector<double> seconds;
    PixelAnswer pixels;
    for (int round = 0; round < kRounds; ++round) {
        pixels = answer(view, bench.occluders, bench.screen, settings.engine, settings.definition);
        seconds.push_back(pixels.seconds);
    }
    const ErrorStatistics errors = errors_of(
        truth, [&](std::size_t i) { return pixels.values[i].occlusion; },
        [](std::size_t) { return true; });
    std::printf(
        "\"direct\": {\"pixels\": %zu, \"solve_s\": %.3f, \"rmse\": %.5f, \"bias\": %.5f, "
        "\"p95\": %.5f, \"max\": %.4f}",
        view.seen().pixels.size(), median(seconds), errors.rmse, errors.bias, errors.p95,
        errors.max);
}

/// Milliseconds to draw a picture's G-buffer, and to project ten maps on it.
void print_projection(Benchmark& bench, const NamedPlaces& places, const CubeSettings& settings)
{
    constexpr PictureSize kSize{1280, 720};
    constexpr std::size_t kMaps = 10;
    CubeProjector projector(bench.context);
    CubeSeconds unused;
    for (std::size_t k = 0; k < kMaps; ++k)
        projector.add(make_cube_map(bench.world(), places.centres[k % places.centres.size()],
                                    settings, unused));
    const View view = view_of(camera_of(bench, kSize), kSize.width, kSize.height);
    GBuffer buffer(bench.context, kSize.width, kSize.height);
    const Framebuffer target = projector.make_target(kSize.width, kSize.height);
    std::vector<double> draw, project;
    for (int round = 0; round <= kRounds; ++round) {
        Stopwatch watch;
        buffer.draw(bench.drawn, view);
        bench.context.finish("drawing");
        draw.push_back(watch.lap());
        projector.project(buffer, target, static_cast<int>(kMaps));
        bench.context.finish("projecting");
        project.push_back(watch.lap());
    }
    draw.erase(draw.begin());  // compiles the shaders
    project.erase(project.begin());
    std::printf("\"projection\": {\"maps\": %zu, \"draw_ms\": %.1f, \"project_ms\": %.1f}", kMaps,
                1e3 * median(draw), 1e3 * median(project));
}

/// Of the places of which the surface from eye to place hides none: one each.
std::vector<std::uint8_t> seen_from(const RayScene& scene, std::span<const Receiver> places,
                                    glm::vec3 eye)
{
    constexpr float kShort = 0.999f;  // of the way: the place's own triangle is not in it
    std::vector<Ray> rays;
    for (const Receiver& place : places) {
        const glm::vec3 way = place.position - eye;
        rays.push_back({eye, glm::normalize(way), kShort * glm::length(way)});
    }
    std::vector<std::uint8_t> seen;
    for (const ClosestHit& hit : closest_hits(scene, rays))
        seen.push_back(hit.triangle == ClosestHit::kNone ? 1 : 0);
    return seen;
}

/// Of places on the surface that stay where they are while the eye moves: how many change by more
/// than 2 of 255 from frame to frame while the eye sees them. Holes have their own answers.
void print_path(Benchmark& bench, const NamedPlaces& places, const CubeSettings& settings)
{
    std::vector<CubeMap> maps;
    CubeSeconds unused;
    for (const glm::vec3 centre : places.centres)
        maps.push_back(make_cube_map(bench.world(), centre, settings, unused));
    const std::vector<SurfacePoint> points = surface_points(bench.mesh.geometry, kPlaces);
    const std::vector<Receiver> receivers =
        receivers_at(bench.mesh.geometry, bench.mesh.surface, points);
    const EngineSettings engine =
        engine_of(bench.world(), std::get<EngineSettings>(settings.engine), settings.definition);
    const std::vector<Occlusion> own =
        solve(bench.occluders.prepared_for(engine), receivers, engine).occlusion;
    std::vector<glm::vec3> centres;
    for (const CubeMap& map : maps)
        centres.push_back(map.centre);
    const std::vector<float> whole(maps.size(), 1.0f);
    const RayScene scene(bench.mesh.geometry, RayScene::Build::robust);
    std::size_t changes[2] = {0, 0};
    float largest[2] = {0.0f, 0.0f};
    for (int way = 0; way < 2; ++way) {  // 0: fading, 1: the nearest as they are
        std::vector<float> before;
        for (int frame = 0; frame < kFrames; ++frame) {
            const float turn = glm::radians(360.0f * static_cast<float>(frame) / kFrames);
            const float r = bench.inside ? 0.25f : 1.2f;
            const glm::vec3 eye(r * std::cos(turn), bench.inside ? r * std::sin(turn) : 0.2f,
                                bench.inside ? 0.0f : r * std::sin(turn));
            std::vector<ProjectedMap> used = nearest_maps(centres, whole, eye, kFewMaps);
            for (ProjectedMap& map : used)
                map.weight = way == 0 ? map.weight : 1.0f;
            const std::vector<std::uint8_t> is_seen = seen_from(scene, receivers, eye);
            std::vector<float> now;
            for (std::size_t i = 0; i < receivers.size(); ++i) {
                const TwinAnswer told =
                    twin_answer(maps, used, receivers[i].position, receivers[i].normal);
                now.push_back(glm::mix(own[i].occlusion, told.occlusion, told.share));
                if (before.empty() || is_seen[i] == 0)
                    continue;
                const float change = std::abs(now.back() - before[i]);
                changes[way] += change > 2.0f / 255.0f ? 1 : 0;
                largest[way] = std::max(largest[way], change);
            }
            before = std::move(now);
        }
    }
    std::printf(
        "\"path\": {\"places\": %zu, \"frames\": %d, \"nearest\": %d, \"maps\": %zu, "
        "\"jumps\": %zu, \"largest\": %.4f, \"jumps_without_fading\": %zu, "
        "\"largest_without_fading\": %.4f}",
        receivers.size(), kFrames, kFewMaps, maps.size(), changes[0], largest[0], changes[1],
        largest[1]);
}

void print_tables(const char* file, bool from_inside, std::size_t pixels, std::uint32_t rays)
{
    Benchmark bench(file, from_inside);
    constexpr PictureSize kSize{960, 540};
    const PixelView view(bench.context, bench.mesh, bench.drawn,
                         view_of(camera_of(bench, kSize), kSize.width, kSize.height), kSize);
    const PixelTruth truth = truth_at(bench, view, pixels, rays);
    CubeSettings masks;
    masks.definition.max_distance = kReach;
    CubeSettings horizon = masks;
    horizon.engine = cube_horizon();
    static_cast<void>(bench.occluders.prepared_for({}));
    std::printf(
        "{\"model\": \"%s\", \"triangles\": %zu, \"inside\": %s, \"reach\": %.2f,\n\"rows\": [",
        bench.mesh.scene.name.c_str(), bench.mesh.geometry.triangles.size(),
        from_inside ? "true" : "false", double{kReach});
    const std::vector<NamedPlaces> placements = placements_of(bench);
    for (const NamedPlaces& places : placements) {
        print_row(bench, places, "masks", masks, view, truth);
        std::printf(",");
        print_row(bench, places, "horizon", horizon, view, truth);
        std::printf("%s", &places == &placements.back() ? "],\n" : ",");
    }
    print_direct(bench, masks, view, truth);
    std::printf(",\n");
    print_projection(bench, placements.back(), masks);
    std::printf(",\n");
    print_path(bench, placements.back(), masks);
    std::printf("}\n");
}

int run(int count, char** words)
{
    const std::string_view kind = count >= 3 ? words[2] : "";
    if ((kind != "ring" && kind != "inside") || (count != 3 && count != 5)) {
        std::fprintf(stderr, "usage: cube_tables MODEL ring|inside [PIXELS RAYS]\n");
        return 2;
    }
    const std::size_t pixels = count == 5 ? std::stoul(words[3]) : 8000;
    const auto rays = static_cast<std::uint32_t>(count == 5 ? std::stoul(words[4]) : 2048);
    print_tables(words[1], kind == "inside", pixels, rays);
    return 0;
}

}  // namespace
}  // namespace surfelao

int main(int count, char** words)
{
    try {
        return surfelao::run(count, words);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "cube_tables: %s\n", error.what());
        return 1;
    }
}
