#include "viewer/shown_error.h"

#include "surfels/number_text.h"

#include <vector>

namespace surfelao {

ErrorStatistics shown_error(std::span<const glm::vec4> pixels)
{
    std::vector<Occlusion> own, traced;
    for (const glm::vec4& pixel : pixels) {
        if (pixel.a == 0.0f)
            continue;
        own.push_back({pixel.r, glm::vec3(0.0f)});
        traced.push_back({pixel.g, glm::vec3(0.0f)});
    }
    return error_statistics(own, traced);
}

float fitting_scale(const ErrorStatistics& error)
{
    return rounded_scale(static_cast<float>(error.p95));
}

std::string note_of(const ErrorStatistics& error)
{
    return "RMSE " + fixed(error.rmse, 4) + "  bias " + signed_fixed(error.bias, 4);
}

Legend difference_legend(const ViewOptions& options)
{
    if (map_of(options) == ColorMap::diverging)
        return {"occlusion less that of rays", -options.difference_scale, options.difference_scale,
                ColorMap::diverging};
    return {"occlusion difference to rays", 0.0f, options.difference_scale, map_of(options)};
}

}  // namespace surfelao
