#include "bake/hidden_texels.h"

#include "reference/closest_hit.h"
#include "reference/sobol.h"
#include "surfels/topology.h"

#include <algorithm>

namespace surfelao {

std::vector<std::uint8_t> texels_maybe_hidden(const Map& visibility,
                                              std::span<const std::uint8_t> known)
{
    const auto is_closed = [&](std::size_t texel) {
        return known[texel] != 0 && visibility.values[texel] <= kHiddenVisibility;
    };
    std::vector<std::size_t> front;
    for (std::size_t texel = 0; texel < visibility.texels(); ++texel) {
        if (!is_closed(texel))
            continue;
        bool is_beside = false;
        for_each_around(visibility, texel, [&](std::size_t other) {
            is_beside |= known[other] != 0 &&
                         visibility.values[other] > visibility.values[texel] + kHiddenVisibility;
        });
        if (is_beside)
            front.push_back(texel);
    }
    if (front.empty())
        return {};
    std::vector<std::uint8_t> marked(visibility.texels(), 0);
    for (const std::size_t texel : front)
        marked[texel] = 1;
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
    if (receivers.empty())
        return inside;
    const SobolPoints points = sobol_points_by_cell(kPacket);
    std::vector<Ray> rays;
    rays.reserve(kPacket * receivers.size());
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        DirectionPacket directions;
        fill_directions(points, 0,
                        hemisphere_over(receivers[i].normal, 0, static_cast<std::uint32_t>(i)),
                        directions);
        for (int k = 0; k < kPacket; ++k)
            rays.push_back({receivers[i].position,
                            {directions.x[k], directions.y[k], directions.z[k]},
                            max_distance});
    }
    const std::vector<ClosestHit> hits = closest_hits(scene, rays);
    const auto meets_mostly = [&](std::size_t receiver, const auto& is_inner) {
        return std::ranges::count_if(std::span(hits).subspan(kPacket * receiver, kPacket),
                                     is_inner) > kPacket / 2;
    };
    for (std::size_t i = 0; i < receivers.size(); ++i)
        inside[i] = meets_mostly(i, [](const ClosestHit& hit) { return hit.is_back; }) ? 1 : 0;
    if (std::ranges::count(inside, 0) == std::ssize(inside))
        return inside;
    const Topology topology = analyse_topology(geometry);
    const auto is_of_body = [&](const ClosestHit& hit) {
        if (!hit.is_back)
            return false;
        const glm::uvec3 t = geometry.triangles[hit.triangle];
        return topology.sides[t.x] == OccluderSide::back &&
               topology.sides[t.y] == OccluderSide::back &&
               topology.sides[t.z] == OccluderSide::back;
    };
    for (std::size_t i = 0; i < receivers.size(); ++i)
        inside[i] = meets_mostly(i, is_of_body) ? 1 : 0;
    return inside;
}

}  // namespace surfelao
