#include "tests/stability/engines.h"

#include "reference/rays.h"

#include <cmath>

namespace surfelao::stability {
namespace {

/// Points of a (0,2)-net miss an area by about n^-3/4 RMS. The scenes hold up to a thousand
/// receivers and some answers are themselves rays, so the worst may be eight times that.
Engine rays(const char* name, RayScene::Build build, std::uint32_t count)
{
    const double rms = std::pow(count, -0.75);
    return {name,
            {2.0 * rms, 8.0 * rms},
            false,
            [build, count](const Geometry& geometry, std::span<const Receiver> receivers,
                           const Definition& definition) {
                RayOptions options;
                options.definition = definition;
                options.rays = count;
                options.seed = 1;  // not the seed of the witness
                return trace_occlusion(RayScene(geometry, build), receivers, options);
            }};
}

}  // namespace

std::vector<Engine> all_engines()
{
    return {
        rays("rays 4096", RayScene::Build::robust, 4096),
        rays("rays 256", RayScene::Build::fast, 256),
    };
}

}  // namespace surfelao::stability
