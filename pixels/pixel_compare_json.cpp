// Of its own: nlohmann's header takes seconds to compile.
#include "pixels/pixel_compare.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace surfelao {
namespace {

using PixelJson = nlohmann::ordered_json;

void add_error(PixelJson& json, const PixelError& error, double ms, const std::string& clock)
{
    json["rmse"] = error.rmse;
    json["rmse_whole"] = error.rmse_whole;
    json["bias"] = error.bias;
    json["p95"] = error.p95;
    json["max"] = error.max;
    json["ms"] = ms;
    json["clock"] = clock;
}

PixelJson json_of(const PixelComparison& comparison, std::size_t index)
{
    const PixelCamera& camera = comparison.cameras[index];
    const Camera& from = camera.from.camera;
    return {{"camera", index + 1},
            {"text", camera.from.text},
            {"eye", {from.eye.x, from.eye.y, from.eye.z}},
            {"target", {from.target.x, from.target.y, from.target.z}},
            {"fovy_deg", from.fovy_deg},
            {"surface_pixels", camera.surface_pixels},
            {"share", camera.share},
            {"noise", camera.noise},
            {"mean_occlusion", camera.mean_occlusion},
            {"from_cache", camera.reference_from_cache}};
}

PixelJson sweep_json(const PixelComparison& comparison, const Sweep& sweep)
{
    const std::vector<double> values = values_of(sweep);
    PixelJson list = PixelJson::array();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const PixelError& error = comparison.means[i].error;
        list.push_back({{"value", values[i]},
                        {"rmse", error.rmse},
                        {"rmse_whole", error.rmse_whole},
                        {"bias", error.bias}});
    }
    return {{"name", name_of(sweep.method) + "." + sweep.name},
            {"best", values[best_of(comparison.means)]},
            {"values", list}};
}

}  // namespace

std::string json_of(const PixelComparison& comparison)
{
    const Definition& definition = comparison.definition;
    PixelJson json;
    json["input"] = comparison.input.string();
    json["triangles"] = comparison.triangles;
    json["width"] = comparison.size.width;
    json["height"] = comparison.size.height;
    json["guard"] = comparison.guard;
    json["threads"] = comparison.threads;
    json["rounds"] = comparison.rounds;
    json["max_distance"] =
        std::isfinite(definition.max_distance) ? PixelJson(definition.max_distance) : PixelJson();
    json["falloff"] = definition.falloff == Falloff::none ? "none" : "smooth";
    json["ground"] = comparison.ground.empty() ? PixelJson() : PixelJson(comparison.ground);
    json["diagonal"] = comparison.diagonal;
    json["renderer"] = comparison.renderer;
    json["software"] = comparison.software;
    json["unit"] = "percent";
    json["reference"] = {{"rays", comparison.reference_rays}};
    json["cameras"] = PixelJson::array();
    for (std::size_t camera = 0; camera < comparison.cameras.size(); ++camera)
        json["cameras"].push_back(json_of(comparison, camera));
    json["rows"] = PixelJson::array();
    for (const PixelRow& row : comparison.rows) {
        PixelJson& entry = json["rows"].emplace_back();
        entry["engine"] = name_of(row.engine);
        entry["setting"] = setting_of(row.engine);
        entry["camera"] = row.camera + 1;
        add_error(entry, row.error, row.ms, row.clock);
    }
    json["means"] = PixelJson::array();
    for (const PixelMean& mean : comparison.means) {
        PixelJson& entry = json["means"].emplace_back();
        entry["engine"] = name_of(mean.engine);
        entry["setting"] = setting_of(mean.engine);
        add_error(entry, mean.error, mean.ms, mean.clock);
    }
    json["sweep"] = comparison.sweep ? sweep_json(comparison, *comparison.sweep) : PixelJson();
    return json.dump(2) + '\n';
}

}  // namespace surfelao
