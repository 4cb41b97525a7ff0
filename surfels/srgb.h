/// srgb.h: between linear light and the numbers that screens and pictures hold.
#pragma once

namespace surfelao {

/// The sRGB transfer function (IEC 61966-2-1): linear light to the value shown, 0 to 1 each. Values
/// outside [0, 1] are cut: a screen shows no more.
[[nodiscard]] float srgb_encode(float linear);

/// The inverse: a value shown, in [0, 1], to linear light.
[[nodiscard]] float srgb_decode(float shown);

}  // namespace surfelao
