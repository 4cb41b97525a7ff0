// family_tables: solve errors of the mask engine over the family of generated scenes.
//
//     family_tables [--limit P] [--smooth] [FIRST [STRIDE]]      default: 0 1, all scenes of both
//     halves
//
// Every scene is solved at the receivers of a bake, at four qualities. The truth are robust rays at
// some of these receivers, spread by area; those without a well-defined answer are left out.
// --limit: a distance limit of so many percent of the diagonal, --smooth: with the smooth falloff.
// JSON on standard output, one object a scene, by which docs/figure_views.py draws the tables.

#include "bake/surface_error.h"
#include "bake/vertex_target.h"
#include "engines/engine.h"
#include "family.h"
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

std::string row_of(std::uint32_t index, const DistanceLimit& limit)
{
    const TargetSettings target_settings;
    const auto mesh = std::make_shared<const Mesh>(
        make_mesh(scenes::family_scene(index), target_settings.normals));
    const VertexTarget target(mesh, target_settings);
    const SurfaceSamples& samples = *target.samples();
    const Definition definition = definition_of(limit, Kernel::cosine, mesh->geometry.frame);

    const std::vector<double> areas(samples.areas.begin(), samples.areas.end());
    const std::vector<std::uint32_t> judged = stratified(areas, kJudged);
    std::vector<Receiver> receivers;
    for (const std::uint32_t i : judged)
        receivers.push_back(target.receivers()[i]);
    const Reference truth =
        trace_reference(mesh->geometry, receivers, {.definition = definition, .rays = kRays});
    std::vector<Occlusion> reference;
    for (std::size_t i = 0; i < judged.size(); ++i)
        if (truth.well_defined(i))
            reference.push_back(truth.occlusion[i]);

    std::string text = "{\"index\": " + std::to_string(index) + ", \"kind\": \"" +
                       scenes::family_kind(index) + "\", \"half\": \"" +
                       (scenes::half_of(index) == scenes::Half::choosing ? "choosing" : "judging") +
                       "\", \"triangles\": " + std::to_string(mesh->scene.triangles.size()) +
                       ", \"receivers\": " + std::to_string(target.receivers().size()) +
                       ", \"noise\": " + exact(truth.noise) + ", \"qualities\": [";
    const Prepared prepared = prepare(mesh->geometry);
    const char* separator = "";
    for (const float quality : kQualities) {
        const Solution solution =
            solve(prepared, target.receivers(), {.definition = definition, .quality = quality});
        std::vector<Occlusion> answers;
        for (std::size_t i = 0; i < judged.size(); ++i)
            if (truth.well_defined(i))
                answers.push_back(solution.occlusion[judged[i]]);
        const ErrorStatistics error = error_statistics(answers, reference, truth.noise);
        text += std::string(separator) + "{\"quality\": " + exact(quality) +
                ", \"rmse\": " + exact(error.rmse) + ", \"bias\": " + exact(error.bias) +
                ", \"p95\": " + exact(error.p95) + ", \"max\": " + exact(error.max) +
                ", \"us\": " + exact(1e6 * solution.seconds / target.receivers().size()) + "}";
        separator = ", ";
    }
    return text + "]}";
}

}  // namespace

int main(int argument_count, char** arguments)
{
    DistanceLimit limit;
    std::vector<std::uint32_t> range;
    for (int i = 1; i < argument_count; ++i) {
        const std::string_view word = arguments[i];
        if (word == "--limit" && i + 1 < argument_count)
            limit = {std::atof(arguments[++i]), true, limit.falloff};
        else if (word == "--smooth")
            limit.falloff = Falloff::smooth;
        else
            range.push_back(static_cast<std::uint32_t>(std::atoi(arguments[i])));
    }
    const char* separator = "[";
    for (std::uint32_t index = range.empty() ? 0 : range[0];
         index<scenes::kFamilySize; index += range.size()> 1 ? range[1] : 1) {
        std::printf("%s\n%s", separator, row_of(index, limit).c_str());
        std::fflush(stdout);
        separator = ",";
    }
    std::printf("\n]\n");
}
