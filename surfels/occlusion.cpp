#include "surfels/occlusion.h"

namespace surfelao {

float hit_weight(const Definition& definition, float t)
{
    if (!(t < definition.max_distance))
        return 0.0f;
    if (definition.falloff == Falloff::none)
        return 1.0f;
    const float x = t / definition.max_distance;
    const float y = 1.0f - x * x;
    return y * y;
}

}  // namespace surfelao
