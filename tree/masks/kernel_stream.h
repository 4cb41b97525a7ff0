/// kernel_stream.h: polygons collected until sixteen can be drawn at once, and how what they cover
/// changes with the place (part of kernel_body.h).
#pragma once

#include "tree/masks/kernel.h"
#include "tree/masks/kernel_raster.h"

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

constexpr float kInversePi = 0.31830989f;

SURFELAO_MASK_INLINE float sum_of(Float16 a)
{
    alignas(64) float lanes[kLanes];
    store(lanes, a);
    float sum = 0.0f;
    for (const float lane : lanes)
        sum += lane;
    return sum;
}

/// How the vector irradiance of what is drawn for a group changes with the place. A small emitter
/// at r with area vector A, r.A > 0, sends f = r (A.r) / (pi r^4); with a receiver that moves by p,
/// r moves by -p: df/dp = (4 r r^T (A.r) / r^2 - (A.r) I - r A^T) / (pi r^4).
class Slope {
public:
    Slope(const ReceiverGroup& group, const MaskLimits& limits)
        : axis_(broadcast(group.axis)), limits_(limits)
    {
    }

    /// The first `count` of 16 polygons; corners as draw takes them, from the group's centre.
    template <int kCorners, int kStride>
    void add(const float* corner, unsigned count)
    {
        Vector16 c[kCorners];
        load_corners<kCorners, kStride>(corner, c);
        const Float16 zero = all(0.0f);
        Vector16 r =
            kCorners == 3 ? (c[0] + c[1] + c[2]) * all(1.0f / 3.0f) : (c[0] + c[2]) * all(0.5f);
        Vector16 area =
            cross(c[2] - c[0], kCorners == 3 ? c[1] - c[0] : c[kCorners - 1] - c[1]) * all(0.5f);
        // beyond the count stands anything
        const Bool16 counts = first_lanes(count) & (zero < dot(r, axis_));
        const Float16 weight = weight_of(dot(r, r));
        const auto choose = [&](Vector16 v) {
            return Vector16{select(counts, v.x, zero), select(counts, v.y, zero),
                            select(counts, v.z, zero)};
        };
        r = choose(r);
        const Float16 inverse = inverse_sqrt(max(dot(r, r), all(kMaskTiny)));
        r = r * inverse;
        area = choose(area) * (inverse * inverse * all(kInversePi) * weight);
        const Int16 away = sign_of(dot(area, r));
        const Float16 along = flip(dot(area, r), away);
        const Float16 direction[3] = {r.x, r.y, r.z};
        const Float16 facing[3] = {flip(area.x, away), flip(area.y, away), flip(area.z, away)};
        for (int i = 0; i < 3; ++i) {
            irradiance_[i] = fma(along, direction[i], irradiance_[i]);
            const Float16 by_distance = direction[i] * inverse;
            for (int j = 0; j < 3; ++j) {
                slope_[i][j] =
                    fma(by_distance, fms(all(4.0f) * along, direction[j], facing[j]), slope_[i][j]);
            }
            slope_[i][i] = slope_[i][i] - along * inverse;
        }
        any_ = true;
    }

    void finish(MaskFlow& flow) const
    {
        if (!any_)
            return;
        for (int i = 0; i < 3; ++i) {
            flow.irradiance[i] += sum_of(irradiance_[i]);
            for (int j = 0; j < 3; ++j)
                flow.slope[i][j] += sum_of(slope_[i][j]);
        }
    }

private:
    /// What counts at the square of a distance.
    SURFELAO_MASK_INLINE Float16 weight_of(Float16 distance2) const
    {
        Float16 weight = all(0.0f);
        for (unsigned k = 0; k < limits_.count; ++k) {
            const Bool16 within = distance2 < all(limits_.distance[k] * limits_.distance[k]);
            weight = weight + select(within, all(limits_.weight[k]), all(0.0f));
        }
        return weight;
    }

    Vector16 axis_;
    const MaskLimits& limits_;
    bool any_ = false;
    Float16 irradiance_[3] = {all(0.0f), all(0.0f), all(0.0f)};
    Float16 slope_[3][3] = {{all(0.0f), all(0.0f), all(0.0f)},
                            {all(0.0f), all(0.0f), all(0.0f)},
                            {all(0.0f), all(0.0f), all(0.0f)}};
};

/// Collects polygons of any receivers until 16 can be drawn at once.
template <int kCorners, bool kSheet>
class Stream {
public:
    /// slope: where all is drawn for a group.
    Stream(const MaskWorld& world, std::uint32_t* masks, Slope* slope = nullptr)
        : raster_(*world.raster), limits_(world.settings.limits), masks_(masks), slope_(slope)
    {
    }

    /// corner: relative to the receivers whose masks begin at masks[target].
    SURFELAO_MASK_INLINE void add(const Vector16* corner, Int16 target, unsigned count)
    {
        for (int i = 0; i < kCorners; ++i) {
            store(corner_[3 * i] + count_, corner[i].x);
            store(corner_[3 * i + 1] + count_, corner[i].y);
            store(corner_[3 * i + 2] + count_, corner[i].z);
        }
        store(target_ + count_, target);
        count_ += count;
        if (count_ >= kLanes) {
            draw_first(kLanes);
            for (int i = 0; i < 3 * kCorners; ++i)
                store(corner_[i], load(corner_[i] + kLanes));
            store(target_, load(target_ + kLanes));
            count_ -= kLanes;
        }
    }

    void finish()
    {
        if (count_ > 0)
            draw_first(count_);
        count_ = 0;
    }

private:
    void draw_first(unsigned count)
    {
        draw<kCorners, 2 * kLanes, kSheet>(raster_, limits_, corner_[0], target_, count, masks_);
        if (slope_ != nullptr)
            slope_->template add<kCorners, 2 * kLanes>(corner_[0], count);
    }

    const MaskRaster& raster_;
    const MaskLimits& limits_;
    std::uint32_t* masks_;
    Slope* slope_;
    unsigned count_ = 0;
    alignas(64) float corner_[3 * kCorners][2 * kLanes] = {};
    alignas(64) std::uint32_t target_[2 * kLanes] = {};
};

/// What is drawn for one group, or for the receivers of one.
struct Streams {
    Stream<4, true> sheets;
    Stream<4, false> rectangles;
    Stream<3, false> triangles;

    Streams(const MaskWorld& world, std::uint32_t* masks, Slope* slope = nullptr)
        : sheets(world, masks, slope),
          rectangles(world, masks, slope),
          triangles(world, masks, slope)
    {
    }

    void finish()
    {
        sheets.finish();
        rectangles.finish();
        triangles.finish();
    }
};

}  // namespace
}  // namespace surfelao::SURFELAO_MASK_ISA
