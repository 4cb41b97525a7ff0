#include "pixels/pixel_samples.h"

#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

constexpr std::size_t kPlaces = kMostExtra + 1;  // of a pixel
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Pixels of one task: a constant, so that what is added comes in the same order whoever works.
constexpr std::size_t kChunk = 8192;

}  // namespace

PixelSamples::PixelSamples(const Mesh& mesh, std::span<const std::uint32_t> parts,
                           const SeenPixels& middles, std::span<const std::uint32_t> pixels,
                           int samples, const BaseColorAt& base)
    : mesh_(mesh),
      parts_(parts),
      seen_(middles),
      pixels_(pixels),
      base_(base),
      chosen_(kPlaces * pixels.size(), kNone),
      middle_shares_(middles.pixels.size())
{
    for_ranges(0, middles.pixels.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        auto next = std::ranges::lower_bound(pixels, middles.pixels[begin]);
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t pixel = middles.pixels[i];
            while (next != pixels.end() && *next < pixel)
                ++next;
            const bool is_listed = next != pixels.end() && *next == pixel;
            if (is_listed)
                chosen_[kPlaces * static_cast<std::size_t>(next - pixels.begin())] =
                    static_cast<std::uint32_t>(i);
            const std::uint32_t count = is_listed ? 1 : static_cast<std::uint32_t>(samples);
            middle_shares_[i] = {
                pixel, count,
                static_cast<float>(count) * (base_ ? base_(middles.points[i]) : glm::vec3(1.0f))};
        }
    });
}

Place PixelSamples::place_of(const View& view, const SurfacePoint& point) const
{
    const Geometry& geometry = mesh_.geometry;
    const glm::uvec3 t = geometry.triangles[point.triangle];
    const glm::uvec3 wedges = mesh_.surface.corners(mesh_.geometry)[point.triangle];
    const glm::vec3 a = geometry.positions[t.x], across = geometry.positions[t.y] - a,
                    along = geometry.positions[t.z] - a;
    const auto& normals = mesh_.surface.normals;
    const glm::vec3 face = glm::cross(across, along);
    glm::vec3 normal = (1.0f - point.at.x - point.at.y) * normals[wedges.x] +
                       point.at.x * normals[wedges.y] + point.at.y * normals[wedges.z];
    const float length = glm::length(normal);
    normal = length > 0.0f ? normal / length : glm::vec3(0.0f);
    const glm::vec3 to_eye = view.lens.orthographic ? -view.forward : view.eye - a;
    if ((glm::dot(normal, face) >= 0.0f) != (glm::dot(to_eye, face) >= 0.0f))
        normal = -normal;
    return {a + point.at.x * across + point.at.y * along, normal, parts_[point.triangle]};
}

const SurfacePoint& PixelSamples::point_of(std::uint32_t chosen) const
{
    return chosen < middle_shares_.size() ? seen_.points[chosen]
                                          : extra_points_[chosen - middle_shares_.size()];
}

PixelSamples::Share& PixelSamples::share_of(std::uint32_t chosen)
{
    return chosen < middle_shares_.size() ? middle_shares_[chosen]
                                          : extra_shares_[chosen - middle_shares_.size()];
}

std::uint32_t PixelSamples::find(const View& view, std::span<const std::uint32_t> chosen,
                                 const SurfacePoint& point) const
{
    const Place own = place_of(view, point);
    const float footprint = footprint_at(view, seen_.height, own.position);
    float least = std::numeric_limits<float>::infinity();
    std::uint32_t nearest = kNone;
    for (const std::uint32_t one : chosen) {
        if (one == kNone)
            return kNone;
        const Place other = place_of(view, point_of(one));
        if (are_like(own, other, footprint))
            return one;
        // of those that are unlike, the one that bends least away: a cosine off counts as a pixel
        const float unlike = off_plane(own, other) / (kLikePlane * footprint) +
                             (1.0f - glm::dot(own.normal, other.normal)) / (1.0f - kLikeNormals);
        if (unlike < least) {
            least = unlike;
            nearest = one;
        }
    }
    return nearest;
}

void PixelSamples::add(const View& view, std::span<const std::uint32_t> triangles)
{
    struct Extra {
        Share share;
        SurfacePoint point;
        std::size_t place;  // of its pixel in pixels_
    };
    SURFELAO_CHECK(triangles.size() == pixels_.size());
    const auto columns = static_cast<std::size_t>(seen_.width);
    std::vector<std::vector<Extra>> added((triangles.size() + kChunk - 1) / kChunk);
    const auto add_pixel = [&](std::size_t place, std::vector<Extra>& extras) {
        const std::uint32_t triangle = triangles[place] - 1, pixel = pixels_[place];
        const std::span<std::uint32_t> chosen(&chosen_[kPlaces * place], kPlaces);
        // nearly always: what the middle sees
        auto like = std::ranges::find_if(chosen, [&](std::uint32_t one) {
            return one == kNone || point_of(one).triangle == triangle;
        });
        std::uint32_t found = like == chosen.end() ? kNone : *like;
        if (found != kNone && !base_) {
            Share& share = share_of(found);
            ++share.samples;
            share.base += glm::vec3(1.0f);
            return;
        }
        const glm::vec2 middle = glm::vec2(pixel % columns, pixel / columns) + 0.5f;
        const SurfacePoint point =
            point_on_ray(mesh_.geometry, view,
                         pixel_ray(view.lens, seen_.width, seen_.height, middle), triangle);
        if (found == kNone)
            found = find(view, chosen, point);
        const glm::vec3 base = base_ ? base_(point) : glm::vec3(1.0f);
        if (found == kNone) {
            extras.push_back({{pixel, 1, base}, point, place});
            return;
        }
        Share& share = share_of(found);
        ++share.samples;
        share.base += base;
    };
    for_tasks(added.size(), [&](std::size_t chunk) {
        const std::size_t end = std::min(triangles.size(), (chunk + 1) * kChunk);
        for (std::size_t place = chunk * kChunk; place < end; ++place) {
            if (triangles[place] != 0)
                add_pixel(place, added[chunk]);
        }
    });

    for (const std::vector<Extra>& extras : added) {
        for (const Extra& extra : extras) {
            const std::span<std::uint32_t> chosen(&chosen_[kPlaces * extra.place], kPlaces);
            *std::ranges::find(chosen, kNone) =
                static_cast<std::uint32_t>(middle_shares_.size() + extra_shares_.size());
            extra_shares_.push_back(extra.share);
            extra_points_.push_back(extra.point);
        }
    }
}

std::uint64_t PixelSamples::edge_pixels() const
{
    std::uint64_t count = 0;
    for (std::size_t place = 0; place < pixels_.size(); ++place) {
        const std::uint32_t first = chosen_[kPlaces * place], second = chosen_[kPlaces * place + 1];
        count += second != kNone || (first != kNone && first >= middle_shares_.size()) ? 1 : 0;
    }
    return count;
}

}  // namespace surfelao
