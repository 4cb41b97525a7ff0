#include "tree/masks/raster.h"

#include "tree/masks/constants.h"

#include <cmath>
#include <memory>
#include <numbers>

namespace surfelao {
namespace {

void set_rows(MaskRaster& raster)
{
    for (int lane = 0; lane < kMaskRows; ++lane) {
        const int y = lane % raster.rows;
        const double angle = ((y + 0.5) / raster.rows - 0.5) * std::numbers::pi / 2.0;
        const double turns = y * (std::numbers::phi - 1.0);
        raster.row_v[lane] = static_cast<float>(std::tan(angle));
        raster.row_shift[lane] = static_cast<float>(turns - std::floor(turns));
        raster.has_below[lane] = y > 0 ? ~0u : 0u;
        raster.has_above[lane] = y + 1 < raster.rows ? ~0u : 0u;
        for (int odd = 0; odd < 2; ++odd)
            raster.side[odd][lane] = (odd * kMaskRows + lane) / raster.rows % 2 == 0 ? 1.0f : -1.0f;
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

/// Whether a moment changes its sign from one face of an axis to the other.
/// order 1: the first moments; 2: the second.
constexpr bool is_odd(int order, int moment)
{
    return order == 1 ? moment == 0 : moment == 1 || moment == 2;
}

/// kOrder: as is_odd().
template <int kOrder, int kMoments, int kParts>
void set_moments(const MaskRaster& raster, std::int8_t (&table)[kMoments][kParts][kMaskFaceBytes],
                 std::int32_t (&sums)[kMoments])
{
    constexpr int kBits = 8 / kParts;
    for (int byte = 0; byte < 4 * raster.rows; ++byte) {
        for (int part = 0; part < kParts; ++part) {
            double mean[6] = {};
            for (int i = 0; i < kBits; ++i) {
                const int y = byte / 4;
                const int x = byte % 4 * 8 + part * kBits + i;
                const double u =
                    (x + static_cast<double>(raster.row_shift[y])) / kMaskHalfColumns - 1.0;
                const double v = raster.row_v[y];
                const double length = std::sqrt(1.0 + u * u + v * v);
                // rows at equal angles: their width in v grows as 1 + v^2
                const double solid_angle = (1.0 + v * v) / (length * length * length);
                const double products[6] = {1.0, u, v, u * u, u * v, v * v};
                for (int m = 0; m < kMoments; ++m)
                    mean[m] += solid_angle / std::pow(length, kOrder) * products[m] / kBits;
            }
            for (int m = 0; m < kMoments; ++m) {
                table[m][part][byte] =
                    static_cast<std::int8_t>(std::lround(kMaskMomentUnit * mean[m]));
                sums[m] += table[m][part][byte];
                if (raster.rows == kMaskCoarseRows)
                    table[m][part][4 * kMaskCoarseRows + byte] = static_cast<std::int8_t>(
                        is_odd(kOrder, m) ? -table[m][part][byte] : table[m][part][byte]);
            }
        }
    }
}

std::unique_ptr<const MaskRaster> make_raster(int rows)
{
    auto made = std::make_unique<MaskRaster>();
    made->rows = rows;
    made->words = kMaskFaces * rows;
    set_rows(*made);
    set_moments<1>(*made, made->first, made->first_sum);
    set_moments<2>(*made, made->second, made->second_sum);
    return made;
}

}  // namespace

const MaskRaster& mask_raster(int rows)
{
    if (rows == kMaskRows) {
        static const std::unique_ptr<const MaskRaster> fine = make_raster(kMaskRows);
        return *fine;
    }
    static const std::unique_ptr<const MaskRaster> coarse = make_raster(kMaskCoarseRows);
    return *coarse;
}

}  // namespace surfelao
