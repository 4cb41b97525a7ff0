#include "surfels/srgb.h"

#include <algorithm>
#include <cmath>

namespace surfelao {

// in double, so that white stays white

float srgb_encode(float linear)
{
    const double x = std::clamp(linear, 0.0f, 1.0f);
    return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055);
}

float srgb_decode(float shown)
{
    const double x = shown;
    return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

}  // namespace surfelao
