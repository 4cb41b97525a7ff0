/// pixel_samples.h: which receivers stand for a pixel that sees more than one surface.
///
/// Asking at every sample inside of every pixel would cost as many times as much as there are
/// samples. But most samples see what the pixel's middle sees. So each pixel keeps a few receivers,
/// the first of them its middle's; every further sample of an edge pixel (edge_pixels.h)
///
///     sees what one of them sees       counts for that one
///     sees something else              is kept itself, up to kMostExtra a pixel
///     and there are as many already    counts for the one nearest to it
///
/// and the pixel's value is the mean of its receivers' values, weighted by their samples. A
/// receiver is always the place of one sample, never a mean of places: those lie on no surface.
/// In all other pixels the samples see what the middle sees.
///
///     ┌─────────┐
///     │ .   . ╱#│   the middle sees the wall: it stands for 7 samples of 10,
///     │   .  ╱# │   one sample of the floor for the 3 others
///     │ . . ╱#  │
///     └─────────┘
#pragma once

#include "pixels/place.h"
#include "pixels/seen.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace surfelao {

/// Receivers of a pixel beside that of its middle. Where five surfaces meet in a pixel, the fifth
/// is a small share of it.
inline constexpr int kMostExtra = 4;

/// The colour of a place, taken at every sample: a texture, which may change within a pixel.
using BaseColorAt = std::function<glm::vec3(const SurfacePoint&)>;

class PixelSamples {
public:
    /// What a receiver stands for.
    struct Share {
        std::uint32_t pixel = 0;
        std::uint32_t samples = 0;
        glm::vec3 base{0.0f};  ///< sum of their base colours; samples * 1 where there are none
    };

    /// middles: what the pixels' middles see, the first sample. pixels: rising, those that add()
    /// tells of; the others' middles stand for all the `samples`. All must outlive this, as the
    /// mesh. parts: parts_of(mesh). base: may be empty; called from many threads.
    PixelSamples(const Mesh& mesh, std::span<const std::uint32_t> parts, const SeenPixels& middles,
                 std::span<const std::uint32_t> pixels, int samples, const BaseColorAt& base = {});

    /// A sample of each of the pixels. view: with the lens of the sample. triangles: one a pixel,
    /// as of seen_pixels(). O(pixels).
    void add(const View& view, std::span<const std::uint32_t> triangles);

    /// Pixels with a receiver beside their middle's, or with one where the middle sees nothing.
    [[nodiscard]] std::uint64_t edge_pixels() const;

    /// One for each of the middles, in their order.
    const std::vector<Share>& middles() const { return middle_shares_; }
    /// The others: the places of those that the samples added, sample by sample, by pixel.
    const std::vector<Share>& extras() const { return extra_shares_; }
    const std::vector<SurfacePoint>& extra_points() const { return extra_points_; }

private:
    [[nodiscard]] Place place_of(const View& view, const SurfacePoint& point) const;
    [[nodiscard]] const SurfacePoint& point_of(std::uint32_t chosen) const;
    [[nodiscard]] Share& share_of(std::uint32_t chosen);
    /// The one of a pixel's chosen that a place counts for; kNone where it is one more.
    [[nodiscard]] std::uint32_t find(const View& view, std::span<const std::uint32_t> chosen,
                                     const SurfacePoint& point) const;

    const Mesh& mesh_;
    std::span<const std::uint32_t> parts_;
    const SeenPixels& seen_;
    std::span<const std::uint32_t> pixels_;
    BaseColorAt base_;
    /// Those of one of the pixels: kMostExtra + 1 numbers each, of the middles first, then the
    /// extras, kNone behind the last.
    std::vector<std::uint32_t> chosen_;
    std::vector<Share> middle_shares_, extra_shares_;
    std::vector<SurfacePoint> extra_points_;
};

}  // namespace surfelao
