#include "viewer/solve_map.h"

#include "bake/bent_space.h"
#include "bake/map_bake.h"

#include <utility>

namespace surfelao {

ModelLayout layout_of(const Model& model, const TexelSettings& texels, const Progress& progress)
{
    TexelLayout found = layout_for(*model.mesh, texels, {}, progress);
    LayoutFacts facts = facts_of(*model.mesh, found.layout);
    return {std::move(found.layout), std::move(facts), found.uv_set};
}

MapAnswer solve_map(const Model& model, const MapLayout& layout, const EngineSettings& engine,
                    std::uint32_t padding, std::uint32_t check, const Progress& progress)
{
    StageProgress stages;
    if (progress)
        stages = [&](std::string_view stage, double done) {
            return progress(stage == "solve" ? done : stage == "check" ? 1.0 : 0.0);
        };
    const MapSettings settings{.padding = padding,
                               .bent = bent_encoder(*model.mesh, layout, BentSpace::world),
                               .check = check};
    MapBake bake = bake_map(*model.mesh, layout, settings, engine,
                            offset_of(model.settings, model.geometry().frame), stages);
    return {.map = {std::move(bake.visibility), std::move(bake.bent)},
            .error = bake.error,
            .seconds = bake.seconds.raster + bake.seconds.solve + bake.seconds.fill};
}

ModelMap reference_map(const Model& model, const MapLayout& layout, const Definition& definition,
                       std::uint32_t rays, std::uint32_t padding, const Progress& progress)
{
    EngineSettings engine;
    engine.engine = Engine::rays;
    engine.rays = rays;
    engine.definition = definition;
    return solve_map(model, layout, engine, padding, 0, progress).map;
}

}  // namespace surfelao
