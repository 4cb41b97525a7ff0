#include "pixels/edge_pixels.h"

#include "pixels/place.h"
#include "surfels/edges.h"
#include "surfels/for_all.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// In pixels: four times what the device rounds a corner to.
constexpr float kReach = 1.0f / 64.0f;

/// An outline counts as nearer than what lies behind it by less than this share of its distance
/// (of the diagonal, without perspective): receivers stand off their surface.
constexpr float kSlack = 1e-3f;

/// Facings of the triangles around a position.
constexpr std::uint8_t kTowards = 1, kAway = 2;

constexpr std::size_t kVertexGrain = 4096;  // vertices of one task

/// What several threads may write at once; read after them.
class Flags {
public:
    explicit Flags(std::size_t count) : flags_(count, 0) {}
    void add(std::size_t i, std::uint8_t bits)
    {
        const std::atomic_ref<std::uint8_t> flag(flags_[i]);
        if ((flag.load(std::memory_order_relaxed) & bits) != bits)
            flag.fetch_or(bits, std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint8_t operator[](std::size_t i) const { return flags_[i]; }
    [[nodiscard]] std::size_t size() const { return flags_.size(); }
    std::vector<std::uint8_t> take() { return std::move(flags_); }

private:
    std::vector<std::uint8_t> flags_;
};

/// One view of a mesh, and what its middles see.
class Finder {
public:
    Finder(const Projected& projected, std::span<const std::uint32_t> parts,
           std::span<const std::uint8_t> ends, const SeenPixels& middles)
        : projected_(projected),
          geometry_(projected.geometry()),
          parts_(parts),
          ends_(ends),
          seen_(middles),
          size_(projected.size()),
          marked_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y))
    {
    }

    std::vector<std::uint32_t> find()
    {
        compare_neighbours();
        trace_outlines();
        std::vector<std::uint32_t> pixels;
        for (std::size_t pixel = 0; pixel < marked_.size(); ++pixel) {
            if (marked_[pixel] != 0)
                pixels.push_back(static_cast<std::uint32_t>(pixel));
        }
        return pixels;
    }

private:
    [[nodiscard]] bool is_orthographic() const { return projected_.view().lens.orthographic; }
    [[nodiscard]] float slack_at(float depth) const
    {
        return is_orthographic() ? kSlack : kSlack * -depth;
    }
    [[nodiscard]] std::size_t pixel_at(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(x);
    }

    void compare_neighbours()
    {
        depths_.assign(marked_.size(), std::numeric_limits<float>::infinity());
        std::vector<std::uint32_t> indices(marked_.size(), kNone);  // of seen_
        for_all(seen_.pixels.size(), [&](std::size_t i) {
            indices[seen_.pixels[i]] = static_cast<std::uint32_t>(i);
            depths_[seen_.pixels[i]] =
                projected_.depth_of(to_view(projected_.view(), seen_.receivers[i].position).z);
        });
        const auto compare = [&](std::size_t pixel, int x, int y) {
            if (x < 0 || x >= size_.x || y >= size_.y)
                return;
            const std::size_t other = pixel_at(x, y);
            if (are_alike(indices[pixel], indices[other]))
                return;
            marked_.add(pixel, 1);
            marked_.add(other, 1);
        };
        for_all(static_cast<std::size_t>(size_.y), kRowGrain, [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < size_.x; ++x) {
                const std::size_t pixel = pixel_at(x, y);
                compare(pixel, x + 1, y);
                for (int dx = -1; dx <= 1; ++dx)
                    compare(pixel, x + dx, y + 1);
            }
        });
    }

    [[nodiscard]] bool are_alike(std::uint32_t one, std::uint32_t other) const
    {
        if (one == kNone || other == kNone)
            return one == other;
        if (seen_.points[one].triangle == seen_.points[other].triangle)
            return true;
        const Place place = place_of(one);
        return are_like(place, place_of(other),
                        footprint_at(projected_.view(), size_.y, place.position));
    }
    [[nodiscard]] Place place_of(std::uint32_t i) const
    {
        const Receiver& receiver = seen_.receivers[i];
        return {receiver.position - receiver.offset * receiver.normal, receiver.normal,
                parts_[seen_.points[i].triangle]};
    }

    void trace_outlines()
    {
        Flags facings(geometry_.positions.size());
        const auto& triangles = geometry_.triangles;
        for_all(triangles.size(), [&](std::size_t t) {
            const glm::vec3& a = projected_.place(triangles[t].x);
            const glm::vec3 face = glm::cross(projected_.place(triangles[t].y) - a,
                                              projected_.place(triangles[t].z) - a);
            const float away = is_orthographic() ? face.z : glm::dot(face, a);
            // seen edge-on: both
            const auto bits = static_cast<std::uint8_t>((away <= 0.0f ? kTowards : 0) |
                                                        (away >= 0.0f ? kAway : 0));
            for (int corner = 0; corner < 3; ++corner)
                facings.add(geometry_.welded[triangles[t][corner]], bits);
        });
        const auto is_outline = [&](std::uint32_t vertex) {
            const std::uint32_t position = geometry_.welded[vertex];
            return ends_[position] != 0 || facings[position] == (kTowards | kAway);
        };
        for_all(triangles.size(), [&](std::size_t t) {
            std::array<bool, 3> are_outline;
            for (int i = 0; i < 3; ++i)
                are_outline[i] = is_outline(triangles[t][i]);
            for (int i = 0; i < 3; ++i) {
                const int next = (i + 1) % 3;
                if (are_outline[i] && are_outline[next])
                    trace(projected_.place(triangles[t][i]), projected_.place(triangles[t][next]));
            }
        });
    }

    /// Marks the pixels that a line touches, where it may be seen.
    void trace(glm::vec3 from, glm::vec3 to)
    {
        const bool is_before = Projected::is_before_eye(from);
        if (is_before && Projected::is_before_eye(to))
            return;
        if (is_before)
            from = Projected::cut(from, to);
        else if (Projected::is_before_eye(to))
            to = Projected::cut(to, from);
        const glm::vec2 a = projected_.in_picture(from), b = projected_.in_picture(to);
        const float depth_a = projected_.depth_of(from.z), depth_b = projected_.depth_of(to.z);
        const int main = std::abs(b.x - a.x) >= std::abs(b.y - a.y) ? 0 : 1, side = 1 - main;
        const float length = b[main] - a[main];
        const PixelBox box = projected_.box_around(glm::min(a, b), glm::max(a, b), kReach);
        for (int m = box.first[main]; m <= box.last[main]; ++m) {
            // where the line enters and leaves this column, or row
            float t0 = 0.0f, t1 = 1.0f;
            if (length != 0.0f) {
                t0 = (static_cast<float>(m) - kReach - a[main]) / length;
                t1 = (static_cast<float>(m + 1) + kReach - a[main]) / length;
                if (t0 > t1)
                    std::swap(t0, t1);
                t0 = glm::clamp(t0, 0.0f, 1.0f);
                t1 = glm::clamp(t1, 0.0f, 1.0f);
            }
            const float s0 = glm::mix(a[side], b[side], t0), s1 = glm::mix(a[side], b[side], t1);
            const float depth =
                std::min(glm::mix(depth_a, depth_b, t0), glm::mix(depth_a, depth_b, t1));
            const PixelBox run = projected_.box_around(glm::vec2(std::min(s0, s1)),
                                                       glm::vec2(std::max(s0, s1)), kReach);
            for (int s = run.first[side]; s <= run.last[side]; ++s)
                mark(main == 0 ? glm::ivec2(m, s) : glm::ivec2(s, m), depth);
        }
    }

    void mark(glm::ivec2 pixel, float depth)
    {
        const std::size_t at = pixel_at(pixel.x, pixel.y);
        if (marked_[at] != 0)
            return;
        const float nearest = depth - slack_at(depth);
        for (int y = std::max(pixel.y - 1, 0); y <= std::min(pixel.y + 1, size_.y - 1); ++y) {
            for (int x = std::max(pixel.x - 1, 0); x <= std::min(pixel.x + 1, size_.x - 1); ++x) {
                if (nearest <= depths_[pixel_at(x, y)]) {
                    marked_.add(at, 1);
                    return;
                }
            }
        }
    }

    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::size_t kRowGrain = 8;  // rows of one task

    const Projected& projected_;
    const Geometry& geometry_;
    std::span<const std::uint32_t> parts_;
    std::span<const std::uint8_t> ends_;
    const SeenPixels& seen_;
    glm::ivec2 size_;
    Flags marked_;
    std::vector<float> depths_;  // of the pixels' middles; nothing there: infinite
};

}  // namespace

EdgeFinder::EdgeFinder(const Mesh& mesh, std::span<const std::uint32_t> parts) : parts_(parts)
{
    const Geometry& geometry = mesh.geometry;
    Flags ends(geometry.positions.size());
    const Edges edges(geometry);
    for_ranges(0, ends.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
        edges.for_each_from(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                            [&](std::uint32_t lower, std::span<const EdgeSide> sides) {
                                if (sides.size() == 2 && sides[0].rises() != sides[1].rises())
                                    return;
                                ends.add(lower, 1);
                                ends.add(sides[0].upper, 1);
                            });
    });
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const std::vector<glm::uvec3>& corners = mesh.surface.corners(geometry);
    std::vector<std::uint32_t> first_wedges(geometry.positions.size(), kNone);
    for (std::size_t t = 0; t < corners.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t position = geometry.welded[geometry.triangles[t][corner]];
            const std::uint32_t wedge = corners[t][corner];
            std::uint32_t& first = first_wedges[position];
            if (first == kNone)
                first = wedge;
            else if (first != wedge && glm::dot(mesh.surface.normals[first],
                                                mesh.surface.normals[wedge]) < kLikeNormals)
                ends.add(position, 1);
        }
    }
    ends_ = ends.take();
}

std::vector<std::uint32_t> EdgeFinder::find(const Projected& projected,
                                            const SeenPixels& middles) const
{
    return Finder(projected, parts_, ends_, middles).find();
}

}  // namespace surfelao
