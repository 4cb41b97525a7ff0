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

/// Rays that tell by themselves where they agree, one in each quarter of the hemisphere.
constexpr std::size_t kFirstRays = 4;

/// What rays `begin` to `end` - 1 of each of the asked receivers meet.
std::vector<ClosestHit> hits_of(const RayScene& scene, std::span<const Receiver> receivers,
                                std::span<const std::uint32_t> asked, std::size_t begin,
                                std::size_t end, float max_distance)
{
    const SobolPoints points = sobol_points_by_cell(kPacket);
    const std::size_t count = end - begin;
    std::vector<Ray> rays(count * asked.size());
    for_all(asked.size(), kReceiverGrain, [&](std::size_t i) {
        const Receiver& receiver = receivers[asked[i]];
        DirectionPacket directions;
        fill_directions(points, 0, hemisphere_over(receiver.normal, 0, asked[i]), directions);
        for (std::size_t k = 0; k < count; ++k) {
            // four points behind each other lie in one quarter
            const std::size_t point =
                (begin + k) % kFirstRays * (kPacket / kFirstRays) + (begin + k) / kFirstRays;
            rays[count * i + k] = {receiver.position,
                                   {directions.x[point], directions.y[point], directions.z[point]},
                                   max_distance};
        }
    });
    return closest_hits(scene, rays);
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
    const std::vector<ClosestHit> first =
        hits_of(scene, receivers, asked, 0, kFirstRays, max_distance);
    std::vector<std::uint32_t> agreed, others;  // that may be inside
    for (const std::uint32_t i : asked) {
        const auto backs = std::ranges::count_if(
            std::span(first).subspan(kFirstRays * i, kFirstRays), &ClosestHit::is_back);
        if (backs > 0)
            (backs == kFirstRays ? agreed : others).push_back(i);
    }
    constexpr std::size_t kRest = kPacket - kFirstRays;
    const std::vector<ClosestHit> rest =
        hits_of(scene, receivers, others, kFirstRays, kPacket, max_distance);
    const auto mark = [&](const auto& is_inner) {
        const auto inner_of_first = [&](std::uint32_t i) {
            return std::ranges::count_if(std::span(first).subspan(kFirstRays * i, kFirstRays),
                                         is_inner);
        };
        for (const std::uint32_t i : agreed)
            inside[i] = 2 * inner_of_first(i) > std::ptrdiff_t{kFirstRays} ? 1 : 0;
        for (std::size_t k = 0; k < others.size(); ++k)
            inside[others[k]] =
                2 * (inner_of_first(others[k]) +
                     std::ranges::count_if(std::span(rest).subspan(kRest * k, kRest), is_inner)) >
                        kPacket
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
