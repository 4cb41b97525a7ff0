#include "viewer/model_map.h"

#include "surfels/number_text.h"

#include <cstdio>

namespace surfelao {

ModelMap open_map(const MapLayout& layout)
{
    const MapSize size = layout.size;
    return {std::vector<Map>(layout.pages.size(), Map(size.width, size.height, 1, 1.0f)),
            std::vector<Map>(layout.pages.size(), Map(size.width, size.height, 3, 0.5f))};
}

std::string text_of(const ModelLayout& layout)
{
    const MapLayout& places = layout.layout;
    std::string text = std::to_string(places.size.width) + " x " +
                       std::to_string(places.size.height) + " texels, ";
    if (places.pages.size() > 1)
        text += std::to_string(places.pages.size()) + " pages, ";
    text += count_text(layout.facts.chart_count, "chart") + ", ";
    const double density = layout.facts.median_density;
    char number[32];
    std::snprintf(number, sizeof number, density < 100.0 ? "%.3g" : "%.0f", density);
    return text + number + " texels per unit (median)";
}

float most_density(const LayoutFacts& facts)
{
    return facts.median_density > 0.0f ? 2.0f * facts.median_density : 1.0f;
}

}  // namespace surfelao
