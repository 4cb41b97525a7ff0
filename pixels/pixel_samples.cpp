#include "pixels/pixel_samples.h"

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

/// How large a pixel is on a plane that faces the eye at this place.
float footprint_at(const View& view, int height, glm::vec3 position)
{
    const float pixel = (view.lens.high.y - view.lens.low.y) / static_cast<float>(height);
    return view.lens.orthographic ? pixel : pixel * glm::dot(position - view.eye, view.forward);
}

}  // namespace

PixelSamples::PixelSamples(const Mesh& mesh, const Rims& rims, std::span<const std::uint32_t> parts,
                           const SeenPixels& middles, const BaseColorAt& base)
    : mesh_(mesh),
      rims_(rims),
      parts_(parts),
      seen_(middles),
      base_(base),
      middle_shares_(middles.pixels.size())
{
    for_all(middles.pixels.size(), kChunk, [&](std::size_t i) {
        middle_shares_[i] = {middles.pixels[i], 1,
                             base_ ? base_(middles.points[i]) : glm::vec3(1.0f)};
    });
}

PixelSamples::Place PixelSamples::place_of(const View& view, const SurfacePoint& point) const
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
    const float near = kLikePlane * footprint_at(view, seen_.height, own.position);
    float least = std::numeric_limits<float>::infinity();
    std::uint32_t nearest = kNone;
    for (const std::uint32_t one : chosen) {
        if (one == kNone)
            return kNone;
        const Place other = place_of(view, point_of(one));
        const float off = std::abs(glm::dot(own.position - other.position, other.normal));
        if (own.part == other.part && off <= near &&
            glm::dot(own.normal, other.normal) >= kLikeNormals)
            return one;
        // of those that are unlike, the one that bends least away: a cosine off counts as a pixel
        const float unlike =
            off / near + (1.0f - glm::dot(own.normal, other.normal)) / (1.0f - kLikeNormals);
        if (unlike < least) {
            least = unlike;
            nearest = one;
        }
    }
    return nearest;
}

std::size_t PixelSamples::add(const View& view, std::span<const std::uint32_t> triangles)
{
    struct Extra {
        Share share;
        SurfacePoint point;
    };
    if (chosen_.empty()) {
        chosen_.assign(kPlaces * triangles.size(), kNone);
        for (std::size_t i = 0; i < seen_.pixels.size(); ++i)
            chosen_[kPlaces * seen_.pixels[i]] = static_cast<std::uint32_t>(i);
    }
    const auto columns = static_cast<std::size_t>(seen_.width);
    std::vector<std::vector<Extra>> added((triangles.size() + kChunk - 1) / kChunk);
    const auto add_pixel = [&](std::size_t pixel, std::vector<Extra>& extras) {
        const std::uint32_t triangle = triangles[pixel] - 1;
        const std::span<std::uint32_t> chosen(&chosen_[kPlaces * pixel], kPlaces);
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
        const SurfacePoint point = rims_.nearer(
            view, seen_.width, seen_.height,
            point_on_ray(mesh_.geometry, view,
                         pixel_ray(view.lens, seen_.width, seen_.height, middle), triangle));
        if (found == kNone)
            found = find(view, chosen, point);
        const glm::vec3 base = base_ ? base_(point) : glm::vec3(1.0f);
        if (found == kNone) {
            extras.push_back({{static_cast<std::uint32_t>(pixel), 1, base}, point});
            return;
        }
        Share& share = share_of(found);
        ++share.samples;
        share.base += base;
    };
    for_tasks(added.size(), [&](std::size_t chunk) {
        const std::size_t end = std::min(triangles.size(), (chunk + 1) * kChunk);
        for (std::size_t pixel = chunk * kChunk; pixel < end; ++pixel) {
            if (triangles[pixel] != 0)
                add_pixel(pixel, added[chunk]);
        }
    });

    const std::size_t before = extra_shares_.size();
    for (const std::vector<Extra>& extras : added) {
        for (const Extra& extra : extras) {
            const std::span<std::uint32_t> chosen(&chosen_[kPlaces * extra.share.pixel], kPlaces);
            *std::ranges::find(chosen, kNone) =
                static_cast<std::uint32_t>(middle_shares_.size() + extra_shares_.size());
            extra_shares_.push_back(extra.share);
            extra_points_.push_back(extra.point);
        }
    }
    return extra_shares_.size() - before;
}

std::uint64_t PixelSamples::edge_pixels() const
{
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < extra_shares_.size(); ++i) {
        const std::uint32_t first = chosen_[kPlaces * extra_shares_[i].pixel];
        const std::uint32_t own = static_cast<std::uint32_t>(middle_shares_.size() + i);
        const std::uint32_t second = chosen_[kPlaces * extra_shares_[i].pixel + 1];
        count += first == own || (second == own && first < middle_shares_.size()) ? 1 : 0;
    }
    return count;
}

}  // namespace surfelao
