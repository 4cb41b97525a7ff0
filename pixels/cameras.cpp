#include "pixels/cameras.h"

#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <cmath>
#include <numbers>

namespace surfelao {

std::vector<NamedCamera> spread_cameras(int count, const CameraWishes& wishes)
{
    SURFELAO_CHECK(count >= 1);
    constexpr double kGoldenAngleDeg = 137.50776405003785;  // 180 (3 - sqrt 5)
    std::vector<std::string> texts;
    for (int k = 0; k < count; ++k) {
        const double height = 1.0 - (2.0 * k + 1.0) / count;
        const double azimuth = std::fmod(
            static_cast<double>(ViewDirection().azimuth_deg) + k * kGoldenAngleDeg, 360.0);
        const double elevation = std::asin(height) * 180.0 / std::numbers::pi;
        texts.push_back("azimuth=" + fixed(azimuth, 2) + ",elevation=" + fixed(elevation, 2));
    }
    return cameras_of(texts, wishes);
}

std::vector<NamedCamera> cameras_of(std::span<const std::string> texts, const CameraWishes& wishes)
{
    std::vector<NamedCamera> cameras;
    for (const std::string& text : texts)
        cameras.push_back({text, parse_camera(text, wishes)});
    return cameras;
}

}  // namespace surfelao
