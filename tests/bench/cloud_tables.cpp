// cloud_tables: how far clouds of points are from the surfaces that they were sampled from.
//
//   cloud_tables rows POINTS MODEL...     JSON: each model clean and noisy, with normals and
//   without cloud_tables family choosing|judging  JSON: the same over generated scenes
//   (tests/family.h) cloud_tables sample MODEL POINTS NOISE normals|none CLOUD.ply [TRUTH.txt]
//
// The truth is that of masks at best on the mesh, at the same points. TRUTH.txt has it beside the
// share of all directions, the whole sphere's, that are open: what CloudCompare's PCV measures
// (tests/bench/clouds/pcv.py).

#include "bake/point_target.h"
#include "family.h"
#include "files/scene_io.h"
#include "random.h"
#include "sampled_cloud.h"
#include "surfels/atomic_file.h"
#include "surfels/number_text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

struct Condition {
    const char* name;
    double noise;  // in spacings
    bool has_normals;
};
constexpr Condition kConditions[] = {
    {"clean, normals", 0.0, true}, {"clean", 0.0, false}, {"noise .3", 0.3, false}};

struct Figures {
    double rmse = 0.0, bias = 0.0, p95 = 0.0, max = 0.0;
    double turned = 0.0, weak = 0.0;  // shares
};

std::vector<Occlusion> truth_of(const Mesh& mesh, const scenes::SampledCloud& sampled)
{
    const std::vector<Receiver> receivers =
        receivers_at(mesh.geometry, mesh.surface, sampled.samples);
    return solve(prepare(mesh.geometry), receivers, {.quality = kBest}).occlusion;
}

Figures figures_of(const Mesh& mesh, const scenes::CloudSampling& sampling)
{
    const scenes::SampledCloud sampled = scenes::sampled(mesh, sampling);
    const std::vector<Occlusion> truth = truth_of(mesh, sampled);
    const PointTarget target = make_point_target(sampled.cloud, {});
    const std::vector<Occlusion> answers = bake_points(target, {}, 0).values;
    const std::vector<Receiver> on_mesh =
        receivers_at(mesh.geometry, mesh.surface, sampled.samples);
    Figures figures;
    std::vector<double> errors;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double error = double{answers[i].occlusion} - double{truth[i].occlusion};
        figures.bias += error;
        errors.push_back(std::abs(error));
        figures.rmse += error * error;
        figures.turned += glm::dot(target.cloud.normals[i], on_mesh[i].normal) < 0.0f;
    }
    std::ranges::sort(errors);
    const auto count = static_cast<double>(errors.size());
    figures.rmse = std::sqrt(figures.rmse / count);
    figures.bias /= count;
    figures.p95 = errors[errors.size() * 95 / 100];
    figures.max = errors.back();
    figures.turned /= count;
    figures.weak = static_cast<double>(target.cloud.counts.weak) / count;
    return figures;
}

void print_rows(std::uint32_t points, int count, char** files)
{
    std::printf("[");
    for (int i = 0; i < count; ++i) {
        const Mesh mesh = make_mesh(read_scene(files[i]));
        for (const Condition& condition : kConditions) {
            const Figures f = figures_of(mesh, {points, condition.noise, condition.has_normals});
            std::printf(
                "%s\n{\"model\": \"%s\", \"points\": %u, \"condition\": \"%s\", "
                "\"rmse\": %.6f, \"bias\": %.6f, \"p95\": %.5f, \"max\": %.4f, "
                "\"turned\": %.6f, \"weak\": %.6f}",
                i == 0 && &condition == kConditions ? "" : ",", mesh.scene.name.c_str(), points,
                condition.name, f.rmse, f.bias, f.p95, f.max, f.turned, f.weak);
            std::fflush(stdout);
        }
    }
    std::printf("\n]\n");
}

/// One in so many scenes, of each kind as many; of 20,000 points each. Geometric means.
constexpr std::uint32_t kFamilyStride = 5;

void print_family(scenes::Half half)
{
    std::printf("[");
    for (const Condition& condition : kConditions) {
        double sum = 0.0, count = 0.0;
        for (std::uint32_t i = 0; i < scenes::kFamilySize; ++i) {
            if (scenes::half_of(i) != half || i / scenes::kFamilyKindCount % kFamilyStride != 0)
                continue;
            const Mesh mesh = make_mesh(scenes::family_scene(i));
            constexpr double kLeast = 1e-4;  // of a logarithm
            sum += std::log(std::max(
                kLeast, figures_of(mesh, {20'000, condition.noise, condition.has_normals}).rmse));
            count += 1.0;
        }
        std::printf("%s\n{\"condition\": \"%s\", \"scenes\": %.0f, \"rmse\": %.6f}",
                    &condition == kConditions ? "" : ",", condition.name, count,
                    std::exp(sum / count));
    }
    std::printf("\n]\n");
}

/// The share of the whole sphere of directions that is open over each point: rays about normals
/// that point anywhere go anywhere.
std::vector<double> open_spheres(const Mesh& mesh, std::span<const Receiver> receivers)
{
    constexpr int kRays = 256;
    const Prepared rays = prepare(mesh.geometry, {.engine = Engine::rays});
    std::vector<double> open(receivers.size(), 0.0);
    Random random(9);
    std::vector<Receiver> asked(receivers.begin(), receivers.end());
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
        for (Receiver& receiver : asked)
            receiver.normal = glm::vec3(random.direction());
        const std::vector<Occlusion> hits = solve(rays, asked, {.rays = 1, .seed = ray}).occlusion;
        for (std::size_t i = 0; i < open.size(); ++i)
            open[i] += (1.0 - double{hits[i].occlusion}) / kRays;
    }
    return open;
}

void write_sample(int count, char** words)
{
    const Mesh mesh = make_mesh(read_scene(words[0]));
    const scenes::SampledCloud sampled =
        scenes::sampled(mesh, {static_cast<std::uint32_t>(std::stoul(words[1])),
                               std::stod(words[2]), std::string_view(words[3]) == "normals"});
    const Scene& cloud = sampled.cloud;
    const bool has_normals = !cloud.normals.empty();
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex " + std::to_string(cloud.positions.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\n" +
        (has_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "") +
        "end_header\n";
    const auto add = [&](glm::vec3 v, char end) {
        append_shortest(text, v.x);
        append_shortest(text += ' ', v.y);
        append_shortest(text += ' ', v.z);
        text += end;
    };
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        add(glm::vec3(cloud.positions[i]), has_normals ? ' ' : '\n');
        if (has_normals)
            add(cloud.normals.values[i], '\n');
    }
    write_atomically(words[4], text);
    if (count < 6)
        return;
    const std::vector<Occlusion> truth = truth_of(mesh, sampled);
    const std::vector<double> open =
        open_spheres(mesh, receivers_at(mesh.geometry, mesh.surface, sampled.samples));
    text.clear();
    for (std::size_t i = 0; i < truth.size(); ++i) {
        append_shortest(text, truth[i].occlusion);
        append_shortest(text += ' ', static_cast<float>(open[i]));
        text += '\n';
    }
    write_atomically(words[5], text);
}

int run(int count, char** words)
{
    const std::string_view what = count > 1 ? words[1] : "";
    if (what == "rows" && count > 3)
        print_rows(static_cast<std::uint32_t>(std::stoul(words[2])), count - 3, words + 3);
    else if (what == "family" && count == 3)
        print_family(std::string_view(words[2]) == "choosing" ? scenes::Half::choosing
                                                              : scenes::Half::judging);
    else if (what == "sample" && (count == 7 || count == 8))
        write_sample(count - 2, words + 2);
    else
        return 2;
    return 0;
}

}  // namespace
}  // namespace surfelao

int main(int count, char** words)
{
    try {
        return surfelao::run(count, words);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "cloud_tables: %s\n", error.what());
        return 1;
    }
}
