#include "viewer/pixel_fill.h"

#include "surfels/errors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace surfelao {
namespace {

constexpr std::uint32_t kNotThere = std::numeric_limits<std::uint32_t>::max();

/// For each pixel of the grid the seen pixel that stands there.
class DraftGrid {
public:
    explicit DraftGrid(const SeenPixels& seen)
        : columns_(static_cast<std::uint32_t>(seen.width)),
          width_((columns_ + kStep - 1) / kStep + 1),
          height_((static_cast<std::uint32_t>(seen.height) + kStep - 1) / kStep + 1),
          seen_(static_cast<std::size_t>(width_) * height_, kNotThere)
    {
        for (std::uint32_t i = 0; i < seen.pixels.size(); ++i) {
            const std::uint32_t x = seen.pixels[i] % columns_, y = seen.pixels[i] / columns_;
            if (x % kStep == 0 && y % kStep == 0)
                seen_[static_cast<std::size_t>(y / kStep) * width_ + x / kStep] = i;
        }
    }

    /// The four around a pixel, left before right, the lower two first; kNotThere where nothing is
    /// seen. At the upper and the right edge two of them do not exist.
    struct Around {
        std::array<std::uint32_t, 4> seen;
        std::array<float, 4> shares;  ///< of the bilinear mean
    };
    [[nodiscard]] Around around(std::uint32_t pixel) const
    {
        const std::uint32_t x = pixel % columns_, y = pixel / columns_;
        const std::size_t first = static_cast<std::size_t>(y / kStep) * width_ + x / kStep;
        const float right = static_cast<float>(x % kStep) / kStep;
        const float above = static_cast<float>(y % kStep) / kStep;
        return {
            {seen_[first], seen_[first + 1], seen_[first + width_], seen_[first + width_ + 1]},
            {(1 - right) * (1 - above), right * (1 - above), (1 - right) * above, right * above}};
    }

private:
    static constexpr std::uint32_t kStep = kDraftStep;
    std::uint32_t columns_, width_, height_;
    std::vector<std::uint32_t> seen_;
};

/// How alike the surface is that two pixels see, above 0 to 1. scale: what is seen of it in a step.
float likeness(const Receiver& a, const Receiver& b, float scale)
{
    constexpr float kLeast = 1.0f / 16.0f;  // steps off the plane: less is the surface's own shape
    const float off = std::abs(glm::dot(a.normal, b.position - a.position)) / (kLeast * scale);
    const float facing = std::max(glm::dot(a.normal, b.normal), 0.05f);
    const float square = facing * facing;
    return square * square / (1.0f + off * off);
}

}  // namespace

std::vector<std::uint32_t> draft_pixels(const SeenPixels& seen)
{
    const DraftGrid grid(seen);
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < seen.pixels.size(); ++i) {
        const DraftGrid::Around around = grid.around(seen.pixels[i]);
        const bool is_alone = std::ranges::count(around.seen, kNotThere) == 4;
        if (around.seen[0] == i || is_alone)
            chosen.push_back(i);
    }
    return chosen;
}

std::vector<std::uint32_t> spread_pixels(const SeenPixels& seen, std::size_t count)
{
    const std::size_t all = seen.pixels.size();
    count = std::min(count, all);
    std::vector<std::uint32_t> chosen;
    constexpr double kGolden = 0.6180339887498949;  // multiples of it fill 0 to 1 evenly
    for (std::size_t i = 0; i < count; ++i) {
        const double place = std::fmod(kGolden * static_cast<double>(i), 1.0);
        const double run = static_cast<double>(all) / static_cast<double>(count);
        chosen.push_back(static_cast<std::uint32_t>(run * (static_cast<double>(i) + place)));
    }
    return chosen;
}

std::vector<Occlusion> fill_draft(const SeenPixels& seen, glm::vec3 eye,
                                  std::span<const std::uint32_t> solved,
                                  std::span<const Occlusion> values)
{
    SURFELAO_CHECK(solved.size() == values.size());
    std::vector<Occlusion> filled(seen.pixels.size());
    std::vector<bool> is_solved(seen.pixels.size(), false);
    for (std::size_t i = 0; i < solved.size(); ++i) {
        filled[solved[i]] = values[i];
        is_solved[solved[i]] = true;
    }
    const DraftGrid grid(seen);
    const float step = static_cast<float>(kDraftStep) / static_cast<float>(seen.height);
    for (std::uint32_t i = 0; i < seen.pixels.size(); ++i) {
        if (is_solved[i])
            continue;
        const DraftGrid::Around around = grid.around(seen.pixels[i]);
        const Receiver& own = seen.receivers[i];
        const float scale = step * glm::distance(eye, own.position);
        Occlusion sum;
        float weights = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            if (around.seen[k] == kNotThere)
                continue;
            constexpr float kLeastShare = 1e-3f;  // where the others see something else
            const float weight = std::max(around.shares[k], kLeastShare) *
                                 likeness(own, seen.receivers[around.seen[k]], scale);
            sum.occlusion += weight * filled[around.seen[k]].occlusion;
            sum.bent_normal += weight * filled[around.seen[k]].bent_normal;
            weights += weight;
        }
        filled[i] = {sum.occlusion / weights, sum.bent_normal / weights};
    }
    return filled;
}

}  // namespace surfelao
