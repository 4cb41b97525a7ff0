#include "bake/hidden_texels.h"

#include "reference/closest_hit.h"
#include "reference/sobol.h"
#include "surfels/for_all.h"
#include "surfels/topology.h"

#include <algorithm>
#include <numeric>

namespace surfelao {
namespace {

constexpr std::size_t kReceiverGrain = 256;  // of one task

constexpr int kHalf = kPacket / 2;

/// What rays `begin` to `begin` + kHalf - 1 of each of the asked receivers meet.
std::vector<ClosestHit> half_of_hits(const RayScene& scene, std::span<const Receiver> receivers,
                                     std::span<const std::uint32_t> asked, int begin,
                                     float max_distance)
{
    const SobolPoints points = sobol_points_by_cell(kPacket);
    std::vector<Ray> rays(kHalf * asked.size());
    for_all(asked.size(), kReceiverGrain, [&](std::size_t i) {
        const Receiver& receiver = receivers[asked[i]];
        DirectionPacket directions;
        fill_directions(points, 0, hemisphere_over(receiver.normal, 0, asked[i]), directions);
        for (int k = 0; k < kHalf; ++k)
            rays[kHalf * i + static_cast<std::size_t>(k)] = {
                receiver.position,
                {directions.x[begin + k], directions.y[begin + k], directions.z[begin + k]},
                max_distance};
    });
    return closest_hits(scene, rays);
}

std::span<const ClosestHit> half_of(const std::vector<ClosestHit>& hits, std::size_t number)
{
    return std::span(hits).subspan(kHalf * number, kHalf);
}

}  // namespace

std::vector<std::uint8_t> texels_maybe_hidden(const Map& visibility,
                                              std::span<const std::uint8_t> known)
{
    const auto is_closed = [&](std::size_t texel) {
        return known[texel] != 0 && visibility.values[texel] <= kHiddenVisibility;
    };
    std::vector<std::uint8_t> marked(visibility.texels(), 0);
    for_all(visibility.texels(), [&](std::size_t texel) {
        if (!is_closed(texel))
            return;
        for_each_around(visibility, texel, [&](std::size_t other) {
            marked[texel] |= known[other] != 0 && visibility.values[other] >
                                                      visibility.values[texel] + kHiddenVisibility;
        });
    });
    std::vector<std::size_t> front;
    for (std::size_t texel = 0; texel < marked.size(); ++texel)
        if (marked[texel] != 0)
            front.push_back(texel);
    if (front.empty())
        return {};
    for (std::uint32_t ring = 1; ring < kHiddenRings; ++ring) {
        std::vector<std::size_t> next;
        for (const std::size_t texel : front)
            for_each_around(visibility, texel, [&](std::size_t other) {
                if (marked[other] != 0 || !is_closed(other))
                    return;
                marked[other] = 1;
                next.push_back(other);
            });
        front = std::move(next);
    }
    return marked;
}

std::vector<std::uint8_t> inside_bodies(const Geometry& geometry, const RayScene& scene,
                                        std::span<const Receiver> receivers, float max_distance)
{
    std::vector<std::uint8_t> inside(receivers.size(), 0);
    std::vector<std::uint32_t> asked(receivers.size());
    std::iota(asked.begin(), asked.end(), 0u);
    const std::vector<ClosestHit> first = half_of_hits(scene, receivers, asked, 0, max_distance);
    // who meets no inner side yet will not meet them mostly
    std::vector<std::uint32_t> may_be;
    for (const std::uint32_t i : asked)
        if (std::ranges::any_of(half_of(first, i), &ClosestHit::is_back))
            may_be.push_back(i);
    const std::vector<ClosestHit> second =
        half_of_hits(scene, receivers, may_be, kHalf, max_distance);
    const auto mark = [&](const auto& is_inner) {
        for (std::size_t k = 0; k < may_be.size(); ++k)
            inside[may_be[k]] = std::ranges::count_if(half_of(first, may_be[k]), is_inner) +
                                            std::ranges::count_if(half_of(second, k), is_inner) >
                                        kHalf
                                    ? 1
                                    : 0;
    };
    mark([](const ClosestHit& hit) { return hit.is_back; });
    if (std::ranges::count(inside, 0) == std::ssize(inside))
        return inside;
    const Topology topology = analyse_topology(geometry);
    mark([&](const ClosestHit& hit) {
        if (!hit.is_back)
            return false;
        const glm::uvec3 t = geometry.triangles[hit.triangle];
        return topology.sides[t.x] == OccluderSide::back &&
               topology.sides[t.y] == OccluderSide::back &&
               topology.sides[t.z] == OccluderSide::back;
    });
    return inside;
}

}  // namespace surfelao
