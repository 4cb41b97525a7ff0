#include "tree/mask_raster.h"

#include <cmath>
#include <memory>
#include <numbers>

namespace surfelao {
namespace {

std::int8_t coordinate(double x)
{
    return static_cast<std::int8_t>(std::lround(127.0 * x));
}

void set_rows(MaskRaster& raster)
{
    for (int y = 0; y < kMaskRows; ++y) {
        const double angle = ((y + 0.5) / kMaskRows - 0.5) * std::numbers::pi / 2.0;
        const double turns = y * (std::numbers::phi - 1.0);
        raster.row_v[y] = static_cast<float>(std::tan(angle));
        raster.row_shift[y] = static_cast<float>(turns - std::floor(turns));
    }
    for (int y = 0; y < kMaskRows; ++y) {
        const auto further = [&](int other) {
            return other >= 0 && other < kMaskRows && raster.row_shift[other] > raster.row_shift[y]
                       ? ~0u
                       : 0u;
        };
        raster.below_is_right[y] = further(y - 1);
        raster.above_is_right[y] = further(y + 1);
    }
}

void set_bits(MaskRaster& raster)
{
    for (int y = 0; y < kMaskRows; ++y) {
        for (int x = 0; x < 32; ++x) {
            const double u = (x + static_cast<double>(raster.row_shift[y])) / 16.0 - 1.0;
            const double v = raster.row_v[y];
            const double length = std::sqrt(1.0 + u * u + v * v);
            // rows at equal angles: their width in v grows as 1 + v^2
            const double solid_angle = (1.0 + v * v) / (length * length * length);
            const int bit = 32 * y + x;
            raster.weight1[bit] =
                static_cast<std::uint8_t>(std::lround(255.0 * solid_angle / length));
            raster.weight2[bit] =
                static_cast<std::uint8_t>(std::lround(255.0 * solid_angle / (length * length)));
            for (int sign = 0; sign < 2; ++sign) {
                const double s = sign == 0 ? 1.0 : -1.0;
                raster.one[sign][bit] = coordinate(s);
                raster.u[sign][bit] = coordinate(s * u);
                raster.v[sign][bit] = coordinate(s * v);
            }
            raster.uu[bit] = coordinate(u * u);
            raster.uv[bit] = coordinate(u * v);
            raster.vv[bit] = coordinate(v * v);
        }
    }
}

void set_nibbles(MaskRaster& raster)
{
    for (int y = 0; y < kMaskRows; ++y) {
        for (int k = 0; k < 8; ++k) {
            for (int value = 0; value < 16; ++value) {
                std::int32_t(&sum1)[4] = raster.sum1[y][k][value];
                std::int32_t(&sum2)[8] = raster.sum2[y][k][value];
                for (int i = 0; i < 4; ++i) {
                    if (!(value >> i & 1))
                        continue;
                    const int bit = 32 * y + 4 * k + i;
                    const int w1 = raster.weight1[bit];
                    const int w2 = raster.weight2[bit];
                    sum1[0] += w1 * raster.one[0][bit];
                    sum1[1] += w1 * raster.u[0][bit];
                    sum1[2] += w1 * raster.v[0][bit];
                    sum2[0] += w2 * raster.one[0][bit];
                    sum2[1] += w2 * raster.u[0][bit];
                    sum2[2] += w2 * raster.v[0][bit];
                    sum2[3] += w2 * raster.uu[bit];
                    sum2[4] += w2 * raster.uv[bit];
                    sum2[5] += w2 * raster.vv[bit];
                }
            }
        }
    }
}

}  // namespace

const MaskRaster& mask_raster()
{
    static const std::unique_ptr<const MaskRaster> raster = [] {
        auto made = std::make_unique<MaskRaster>();
        set_rows(*made);
        set_bits(*made);
        set_nibbles(*made);
        return made;
    }();
    return *raster;
}

}  // namespace surfelao
