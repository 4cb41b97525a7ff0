#include "grid/ao_grid.h"

#include <cmath>

namespace surfelao {

std::string name_of(GridStore store)
{
    return store == GridStore::cone ? "cone" : "sh";
}

std::string name_of(GridBorder border)
{
    return border == GridBorder::fade ? "fade" : "rescale";
}

float warped(float x, float a, float s)
{
    const float size = std::abs(x);
    const float u = size < a ? s * size / a : s + (1.0f - s) * (size - a) / (1.0f - a);
    return std::copysign(u, x);
}

float unwarped(float u, float a, float s)
{
    const float size = std::abs(u);
    const float x = size < s ? a * size / s : a + (1.0f - a) * (size - s) / (1.0f - s);
    return std::copysign(x, u);
}

}  // namespace surfelao
