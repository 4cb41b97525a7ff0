// family_tables: solve errors of the mask engine over the family of generated scenes, and of files.
//
//     family_tables [--limit P] [--smooth] [FIRST STRIDE] [NAME=FILE...]
//
// Of the family the scenes FIRST, FIRST + STRIDE, ... (0 1: all of both halves) are taken. Every
// scene is solved at the receivers of a bake, at four qualities. The truth are robust rays at some
// of these receivers, spread by area; those without a well-defined answer are left out. --limit: a
// distance limit of so many percent of the diagonal; --smooth: with the smooth falloff. JSON on
// standard output, one object a scene, by which docs/family_views.py draws the tables.

#include "bake/surface_error.h"
#include "bake/vertex_target.h"
#include "engines/engine.h"
#include "family.h"
#include "files/scene_io.h"
#include "reference/reference_cache.h"
#include "surfels/number_text.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace surfelao;

constexpr float kQualities[] = {kDraft, kGood, kBest, 4.0f};
constexpr std::uint64_t kJudged = 2000;
constexpr std::uint32_t kRays = 4096;

/// What is right at some of a target's receivers.
struct Truth {
    std::vector<std::uint32_t> receivers;  ///< the well-defined ones
    std::vector<Occlusion> reference;
    double noise = 0.0;
};

Truth truth_of(const Mesh& mesh, const VertexTarget& target, const Definition& definition)
{
    const SurfaceSamples& samples = *target.samples();
    const std::vector<double> areas(samples.areas.begin(), samples.areas.end());
    const std::vector<std::uint32_t> judged = stratified(areas, kJudged);
    std::vector<Receiver> receivers;
    for (const std::uint32_t i : judged)
        receivers.push_back(target.receivers()[i]);
    const Reference traced =
        trace_reference(mesh.geometry, receivers, {.definition = definition, .rays = kRays});
    Truth truth;
    truth.noise = traced.noise;
    for (std::size_t i = 0; i < judged.size(); ++i)
        if (traced.well_defined(i)) {
            truth.receivers.push_back(judged[i]);
            truth.reference.push_back(traced.occlusion[i]);
        }
    return truth;
}

/// `"noise": ..., "qualities": [...]`
std::string errors_of(Scene scene, const DistanceLimit& limit)
{
    const TargetSettings settings;
    const auto mesh = std::make_shared<const Mesh>(make_mesh(std::move(scene), settings.normals));
    const VertexTarget target(mesh, settings);
    const Definition definition = definition_of(limit, Kernel::cosine, mesh->geometry.frame);
    const Truth truth = truth_of(*mesh, target, definition);
    const Prepared prepared = prepare(mesh->geometry);
    std::string text = "\"triangles\": " + std::to_string(mesh->scene.triangles.size()) +
                       ", \"receivers\": " + std::to_string(target.receivers().size()) +
                       ", \"noise\": " + exact(truth.noise) + ", \"qualities\": [";
    const char* separator = "";
    for (const float quality : kQualities) {
        const Solution solution =
            solve(prepared, target.receivers(), {.definition = definition, .quality = quality});
        std::vector<Occlusion> answers;
        for (const std::uint32_t i : truth.receivers)
            answers.push_back(solution.occlusion[i]);
        const ErrorStatistics error = error_statistics(answers, truth.reference, truth.noise);
        text += std::string(separator) + "{\"quality\": " + exact(quality) +
                ", \"rmse\": " + exact(error.rmse) + ", \"bias\": " + exact(error.bias) +
                ", \"p95\": " + exact(error.p95) + ", \"max\": " + exact(error.max) +
                ", \"us\": " + exact(1e6 * solution.seconds / target.receivers().size()) + "}";
        separator = ", ";
    }
    return text + "]";
}

void print(std::string_view kind, std::string_view half, const std::string& errors)
{
    static const char* separator = "[";
    std::printf("%s\n{\"kind\": \"%.*s\", \"half\": \"%.*s\", %s}", separator,
                static_cast<int>(kind.size()), kind.data(), static_cast<int>(half.size()),
                half.data(), errors.c_str());
    std::fflush(stdout);
    separator = ",";
}

}  // namespace

int main(int argument_count, char** arguments)
{
    DistanceLimit limit;
    std::vector<std::string_view> files;
    std::vector<std::uint32_t> range;
    for (int i = 1; i < argument_count; ++i) {
        const std::string_view word = arguments[i];
        if (word == "--limit" && i + 1 < argument_count)
            limit = {std::atof(arguments[++i]), true, limit.falloff};
        else if (word == "--smooth")
            limit.falloff = Falloff::smooth;
        else if (word.find('=') != word.npos)
            files.push_back(word);
        else
            range.push_back(static_cast<std::uint32_t>(std::atoi(arguments[i])));
    }
    if (range.size() == 2)
        for (std::uint32_t i = range[0]; i < scenes::kFamilySize; i += range[1])
            print(scenes::family_kind(i),
                  scenes::half_of(i) == scenes::Half::choosing ? "choosing" : "judging",
                  errors_of(scenes::family_scene(i), limit));
    for (const std::string_view word : files) {
        const std::size_t sign = word.find('=');
        print(word.substr(0, sign), "model", errors_of(read_scene(word.substr(sign + 1)), limit));
    }
    std::printf("\n]\n");
}
