// The comparison of AO grids as JSON: a file of its own, as json.cpp, for nlohmann's header.
#include "bake/grid_compare.h"

#include <nlohmann/json.hpp>

namespace surfelao {
namespace {

using GridJson = nlohmann::ordered_json;

GridJson list_of(glm::dvec3 v)
{
    return {v.x, v.y, v.z};
}

}  // namespace

std::string json_of(const GridComparison& comparison)
{
    GridJson rows = GridJson::array();
    for (const GridRow& row : comparison.rows)
        rows.push_back({{"engine", name_of(row.engine.engine)},
                        {"setting", setting_of(row.engine)},
                        {"resolution", row.grid.resolution},
                        {"store", name_of(row.grid.store)},
                        {"extent", row.grid.extent},
                        {"uniform", row.grid.uniform},
                        {"border", name_of(row.grid.border)},
                        {"origin", row.is_origin},
                        {"build_s", row.build_s},
                        {"solve_s", row.solve_s},
                        {"repair_s", row.repair_s},
                        {"inside", row.inside},
                        {"receivers", row.receivers},
                        {"bytes", row.bytes},
                        {"error",
                         {{"rmse", row.error.rmse},
                          {"bias", row.error.bias},
                          {"p95", row.error.p95},
                          {"max", row.error.max}}}});
    const GridJson json = {
        {"input", comparison.input.string()},
        {"triangles", comparison.triangles},
        {"box", {{"low", list_of(comparison.box.low)}, {"high", list_of(comparison.box.high)}}},
        {"places", comparison.places},
        {"rms_occlusion", comparison.rms_occlusion},
        {"reference", {{"rays", comparison.reference_rays}, {"noise", comparison.reference_noise}}},
        {"threads", comparison.threads},
        {"rounds", comparison.rounds},
        {"rows", rows}};
    return json.dump(2) + "\n";
}

}  // namespace surfelao
