#include "bake/json.h"

#include <cmath>

namespace surfelao {

Json json_of(const EngineSettings& settings)
{
    const Definition& definition = settings.definition;
    Json json;
    json["device"] = settings.device == Device::gpu ? "gpu" : "cpu";
    if (settings.engine == Engine::rays)
        json["rays"] = settings.rays;
    else
        json["quality"] = settings.quality;
    if (settings.engine == Engine::disks) {
        json["passes"] = settings.passes;
        json["strength"] = settings.strength;
    }
    if (settings.instructions == Instructions::avx2)
        json["instructions"] = "avx2";
    json["kernel"] = definition.kernel == Kernel::cosine ? "cosine" : "bunnell";
    json["max_distance"] =
        std::isfinite(definition.max_distance) ? Json(definition.max_distance) : Json();
    json["falloff"] = definition.falloff == Falloff::none ? "none" : "smooth";
    json["offset"] = definition.offset;
    return json;
}

}  // namespace surfelao
