// stated_tables: whether bakes err as they say, over the family of generated scenes.
//
//     stated_tables [FIRST [STRIDE]]      default: 0 1, all scenes of both halves
//
// Each scene is baked at good, states its error, and is measured again at ten times the points,
// which lie elsewhere; then it is baked with `--error .01` and `--error .005`. JSON on standard
// output, one object a scene, by which docs/figure_views.py draws the table.

#include "bake/stated_error.h"
#include "bake/vertex_bake.h"
#include "family.h"
#include "surfels/number_text.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace {

using namespace surfelao;

constexpr double kAsked[] = {0.01, 0.005};

struct World {
    std::shared_ptr<const Mesh> mesh;
    VertexTarget target;
};

World world_of(std::uint32_t index)
{
    const TargetSettings settings;
    auto mesh =
        std::make_shared<const Mesh>(make_mesh(scenes::family_scene(index), settings.normals));
    VertexTarget target(mesh, settings);
    return {mesh, std::move(target)};
}

/// At ten times the points of a bake.
StatedError judged(const World& world, const VertexBake& bake)
{
    ErrorCheck check(*world.mesh, world.target, bake.answers, bake.values, {}, 10 * kCheckPoints);
    check.trace({}, bake.values);
    return check.error_of(bake.answers, bake.values);
}

std::string number(double value)
{
    return std::isfinite(value) ? exact(value) : "null";
}

/// What is said and what is true, with every point as much too dark as all are in the mean put
/// right: whether that helps elsewhere.
std::string row_of(std::uint32_t index)
{
    const World world = world_of(index);
    const VertexBake good = bake_vertices(*world.mesh, world.target, {}, {}, kCheckPoints);
    const StatedError& stated = *good.error;
    const StatedError truth = judged(world, good);
    const double square = truth.rmse * truth.rmse;
    const double corrected = square - 2.0 * stated.bias * truth.bias + stated.bias * stated.bias;
    std::string text = "{\"kind\": \"" + std::string(scenes::family_kind(index)) +
                       "\", \"half\": \"" +
                       (scenes::half_of(index) == scenes::Half::choosing ? "choosing" : "judging") +
                       "\", \"triangles\": " + std::to_string(world.mesh->scene.triangles.size()) +
                       ", \"rmse\": " + number(stated.rmse) + ", \"low\": " + number(stated.low) +
                       ", \"high\": " + number(stated.high) +
                       ", \"floor\": " + number(stated.floor.value_or(NAN)) +
                       ", \"truth\": " + number(truth.rmse) + ", \"bias\": " + number(stated.bias) +
                       ", \"true_bias\": " + number(truth.bias) +
                       ", \"corrected\": " + number(std::sqrt(std::max(0.0, corrected)));
    for (const double asked : kAsked) {
        const VertexBake bake =
            bake_to_error(*world.mesh, world.target, {}, {}, asked, kCheckPoints);
        text += ", \"asked_" + number(asked) + "\": {\"met\": " + (bake.is_met ? "true" : "false") +
                ", \"engine\": \"" + name_of(bake.engine.engine) + "\", \"setting\": \"" +
                setting_of(bake.engine) + "\", \"rmse\": " + number(bake.error->rmse) +
                ", \"trials\": " + std::to_string(bake.trials.size()) +
                ", \"truth\": " + number(judged(world, bake).rmse) + "}";
    }
    return text + "}";
}

}  // namespace

int main(int argument_count, char** arguments)
{
    const auto number_at = [&](int place, int otherwise) {
        return static_cast<std::uint32_t>(argument_count > place ? std::atoi(arguments[place])
                                                                 : otherwise);
    };
    const char* separator = "[";
    for (std::uint32_t index = number_at(1, 0); index < scenes::kFamilySize;
         index += number_at(2, 1)) {
        std::printf("%s\n%s", separator, row_of(index).c_str());
        std::fflush(stdout);
        separator = ",";
    }
    std::printf("\n]\n");
}
