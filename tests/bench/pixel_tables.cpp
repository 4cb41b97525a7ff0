// pixel_tables: the exact pass at the pixels of a picture: how wrong, how long, and what two
// cameras say of the same point.
//
//   pixel_tables exact POINTS WIDTH HEIGHT MODEL...
//                                 JSON: two views of each model, a near one too, without a limit
//                                 and with one of a tenth of the diagonal, draft and good. Errors
//                                 against robust rays at so many of the pixels' middles, evenly
//                                 spread over the pixels in their order.
//
//                                 Then the same of all views together, as "all": without times.
//
// between: the RMS difference, at places of the first view's pixels that the second one sees too,
// of the answers there among the first view's receivers and among the second's.

#include "bake/surface_error.h"
#include "files/scene_io.h"
#include "pixels/pixel_picture.h"
#include "surfels/heap_pages.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

constexpr std::uint32_t kTruthRays = 1024;
constexpr int kRounds = 3;
/// From where: the whole scene, and so near to it that it fills most of the picture.
struct Standpoint {
    ViewDirection direction;
    float distance;  // of the framed view's
};
constexpr Standpoint kStandpoints[] = {{{30.0f, 18.0f}, 1.0f}, {{10.0f, 10.0f}, 0.35f}};
constexpr float kLimits[] = {std::numeric_limits<float>::infinity(), 0.1f};

struct ExactWorld {
    const GlContext& context;
    const Mesh& mesh;
    const DrawnMesh& drawn;
    Occluders& occluders;
    PictureSize size;
};

/// All views of one setting together.
struct Pool {
    float limit = 0.0f;
    float quality = 0.0f;
    std::vector<Occlusion> answers = {}, reference = {};
    double noise2 = 0.0;    // of the reference, times points
    double between2 = 0.0;  // of each view, summed
    std::uint64_t ill_defined = 0;
    int views = 0;
};

/// What one camera sees.
struct Sight {
    View view;
    SeenPixels seen;
};

Sight sight_of(const ExactWorld& world, const Standpoint& standpoint)
{
    const float aspect =
        static_cast<float>(world.size.width) / static_cast<float>(world.size.height);
    Sight sight;
    Camera camera =
        frame_points(framed_points(world.mesh.geometry), UpAxis::y, aspect, standpoint.direction);
    zoom(camera, standpoint.distance);
    sight.view = view_of(camera, world.size.width, world.size.height);
    sight.seen = seen_pixels(world.mesh, Projected(world.mesh.geometry, sight.view,
                                                   world.size.width, world.size.height));
    return sight;
}

/// So many of `all`, evenly spread.
template <class T>
std::vector<T> spread(const std::vector<T>& all, std::size_t count)
{
    std::vector<T> chosen;
    for (std::size_t i = 0; i < std::min(count, all.size()); ++i)
        chosen.push_back(all[(2 * i + 1) * all.size() / (2 * std::min(count, all.size()))]);
    return chosen;
}

/// Answers at those of the spread places that the truth has kept, in its order.
std::vector<Occlusion> kept(const SurfaceTruth& truth, const std::vector<Receiver>& asked,
                            const std::vector<Occlusion>& answers)
{
    std::vector<Occlusion> values;
    std::size_t next = 0;
    for (const Receiver& receiver : truth.receivers) {
        while (asked[next].position != receiver.position || asked[next].normal != receiver.normal)
            ++next;
        values.push_back(answers[next++]);
    }
    return values;
}

/// See above. other: the second view.
double between(const ExactWorld& world, const Sight& sight, const std::vector<Occlusion>& answers,
               const Sight& other, const EngineSettings& engine)
{
    std::vector<Receiver> asked = other.seen.receivers;
    std::vector<std::size_t> places(
        static_cast<std::size_t>(world.size.width) * static_cast<std::size_t>(world.size.height),
        asked.size());
    for (std::size_t i = 0; i < asked.size(); ++i)
        places[other.seen.pixels[i]] = i;
    std::vector<std::pair<std::size_t, std::size_t>> shared;  // place in `asked`, in `answers`
    const glm::vec2 size(world.size.width, world.size.height);
    const Lens& lens = other.view.lens;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const glm::vec3 p = to_view(other.view, sight.seen.receivers[i].position);
        if (p.z <= 0.0f)
            continue;
        const glm::vec2 pixel =
            glm::floor((glm::vec2(p) / p.z - lens.low) / (lens.high - lens.low) * size);
        if (glm::any(glm::lessThan(pixel, glm::vec2(0.0f))) ||
            glm::any(glm::greaterThanEqual(pixel, size)))
            continue;
        const std::size_t at =
            static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(world.size.width) +
            static_cast<std::size_t>(pixel.x);
        if (places[at] == other.seen.points.size() ||
            other.seen.points[places[at]].triangle != sight.seen.points[i].triangle)
            continue;
        const std::vector<Receiver> turned =
            receivers_facing(world.mesh, other.view, std::span(sight.seen.points).subspan(i, 1));
        if (turned[0].normal != sight.seen.receivers[i].normal)
            continue;
        asked[places[at]] = turned[0];
        shared.emplace_back(places[at], i);
    }
    const std::vector<Occlusion> others =
        solve(world.occluders.prepared_for(engine), asked, engine).occlusion;
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < shared.size(); ++k) {
        const auto [place, own] = shared[k];
        // of two places of one pixel the second took the first one's
        if (asked[place].position != sight.seen.receivers[own].position)
            continue;
        const double difference = double{others[place].occlusion} - double{answers[own].occlusion};
        sum += difference * difference;
        ++count;
    }
    return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

double median_of(std::vector<double> values)
{
    return quantile(std::move(values), 0.5);
}

/// Seconds of a picture whose engine is prepared, the median of several.
struct PictureSeconds {
    double prepare = 0.0, see = 0.0, solve = 0.0, edges = 0.0;
    std::uint64_t extras = 0;
};

PictureSeconds time_picture(const ExactWorld& world, const Sight& sight,
                            const EngineSettings& engine)
{
    const PixelPaint paint{
        [](const AnsweredPixel& pixel) { return glm::vec3(1.0f - pixel.value.occlusion); }};
    std::vector<double> prepare, see, solve, edges;
    PictureSeconds seconds;
    for (int round = 0; round < kRounds; ++round) {
        const PixelPicture picture = pixel_picture(
            world.context, world.mesh, world.drawn, world.occluders, sight.view,
            {.size = world.size, .engine = engine, .definition = engine.definition}, paint);
        prepare.push_back(picture.prepare_s);
        see.push_back(picture.see_s);
        solve.push_back(picture.solve_s);
        edges.push_back(picture.edges_s);
        seconds.extras = picture.extras;
    }
    seconds.prepare = median_of(prepare);
    seconds.see = median_of(see);
    seconds.solve = median_of(solve);
    seconds.edges = median_of(edges);
    return seconds;
}

Pool& pool_of(std::vector<Pool>& pools, float limit, float quality)
{
    for (Pool& pool : pools) {
        if (pool.limit == limit && pool.quality == quality)
            return pool;
    }
    return pools.emplace_back(Pool{.limit = limit, .quality = quality});
}

std::string errors_text(const ErrorStatistics& error, std::uint64_t ill_defined, double between)
{
    char text[256];
    std::snprintf(text, sizeof text,
                  "\"points\": %llu, \"ill_defined\": %llu, \"rmse\": %.6f, \"bias\": %.6f, "
                  "\"p95\": %.5f, \"max\": %.4f, \"between\": %.6f",
                  static_cast<unsigned long long>(error.count),
                  static_cast<unsigned long long>(ill_defined), error.rmse, error.bias, error.p95,
                  error.max, between);
    return text;
}

std::string begin_of(const std::string& model, float limit, float quality)
{
    EngineSettings engine;
    engine.quality = quality;
    char text[256];
    std::snprintf(text, sizeof text, "{\"model\": \"%s\", \"limit\": %g, \"setting\": \"%s\"",
                  model.c_str(), std::isfinite(limit) ? double{limit} : 0.0,
                  setting_of(engine).c_str());
    return text;
}

/// One row: a view with a limit by an engine.
void print_row(const ExactWorld& world, const Sight& sight, const Sight& other,
               const SurfaceTruth& truth, const EngineSettings& engine,
               const std::vector<Receiver>& asked, Pool& pool)
{
    const Prepared& prepared = world.occluders.prepared_for(engine);
    const std::vector<Occlusion> answers = solve(prepared, sight.seen.receivers, engine).occlusion;
    const std::vector<Occlusion> judged = kept(truth, asked, spread(answers, asked.size()));
    const double apart = between(world, sight, answers, other, engine);
    const PictureSeconds seconds = time_picture(world, sight, engine);
    std::printf(
        ", \"pixels\": %zu, %s, \"tree_s\": %.4f, \"outlines_s\": %.4f, \"see_s\": %.4f, "
        "\"solve_s\": %.4f, \"edges_s\": %.4f, \"extras\": %llu}",
        sight.seen.pixels.size(),
        errors_text(error_against(truth, judged), truth.ill_defined, apart).c_str(),
        prepared.seconds().surfels + prepared.seconds().tree, seconds.prepare, seconds.see,
        seconds.solve, seconds.edges, static_cast<unsigned long long>(seconds.extras));
    std::fflush(stdout);
    pool.answers.insert(pool.answers.end(), judged.begin(), judged.end());
    pool.reference.insert(pool.reference.end(), truth.reference.begin(), truth.reference.end());
    pool.noise2 += truth.noise * truth.noise * static_cast<double>(judged.size());
    pool.between2 += apart * apart;
    pool.ill_defined += truth.ill_defined;
    ++pool.views;
}

void print_model(const GlContext& context, const char* file, PictureSize size, std::size_t points,
                 std::vector<Pool>& pools)
{
    const Mesh mesh = make_mesh(read_scene(file));
    const DrawnMesh drawn(context, mesh.geometry, mesh.surface);
    Occluders occluders(mesh.geometry);
    const ExactWorld world{context, mesh, drawn, occluders, size};
    const Sight sights[] = {sight_of(world, kStandpoints[0]), sight_of(world, kStandpoints[1])};
    for (const float limit : kLimits) {
        for (int v = 0; v < 2; ++v) {
            const Sight& sight = sights[v];
            const std::vector<Receiver> asked = spread(sight.seen.receivers, points);
            TruthSettings truth_settings;
            truth_settings.definition.max_distance = limit;
            truth_settings.rays = kTruthRays;
            const SurfaceTruth truth = trace_truth(mesh.geometry, spread(sight.seen.points, points),
                                                   asked, truth_settings);
            for (const float quality : {kDraft, kGood}) {
                EngineSettings engine;
                engine.quality = quality;
                engine.definition = truth_settings.definition;
                std::printf("%s, \"view\": %d", begin_of(mesh.scene.name, limit, quality).c_str(),
                            v + 1);
                print_row(world, sight, sights[1 - v], truth, engine, asked,
                          pool_of(pools, limit, quality));
                std::printf(",\n");
            }
        }
    }
}

void print_pools(const std::vector<Pool>& pools)
{
    for (const Pool& pool : pools) {
        const double noise = std::sqrt(
            pool.noise2 / static_cast<double>(std::max<std::size_t>(1, pool.answers.size())));
        std::printf("%s, %s}%s\n", begin_of("all", pool.limit, pool.quality).c_str(),
                    errors_text(error_statistics(pool.answers, pool.reference, noise),
                                pool.ill_defined, std::sqrt(pool.between2 / pool.views))
                        .c_str(),
                    &pool == &pools.back() ? "" : ",");
    }
}

int run(int count, char** words)
{
    if (count < 6 || std::string_view(words[1]) != "exact")
        return 2;
    const GlContext context = GlContext::create(GlBackend::osmesa);
    const PictureSize size{std::stoi(words[3]), std::stoi(words[4])};
    std::vector<Pool> pools;
    std::printf("[\n");
    for (int i = 5; i < count; ++i)
        print_model(context, words[i], size, std::stoul(words[2]), pools);
    print_pools(pools);
    std::printf("]\n");
    return 0;
}

}  // namespace
}  // namespace surfelao

int main(int count, char** words)
{
    surfelao::keep_heap_pages();  // as the program does
    try {
        return surfelao::run(count, words);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "pixel_tables: %s\n", error.what());
        return 1;
    }
}
