#include "reference/rays.h"

#include "reference/closest_hit.h"
#include "reference/embree_scene.h"
#include "reference/sobol.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_sort.h>
#include <xmmintrin.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace surfelao {
namespace {

/// Denormals cost the traversal up to a hundred cycles each and change nothing here.
class FlushDenormals {
public:
    FlushDenormals() : saved_(_mm_getcsr())
    {
        _mm_setcsr(saved_ | kFlushToZero | kDenormalsAreZero);
    }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    static constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
    unsigned saved_;
};

/// Embree's packet types and calls by width.
template <int width>
struct Packets;

template <>
struct Packets<16> {
    using Ray = RTCRay16;
    using RayHit = RTCRayHit16;
    static constexpr auto occluded = rtcOccluded16;
    static constexpr auto intersect = rtcIntersect16;
};

template <>
struct Packets<8> {
    using Ray = RTCRay8;
    using RayHit = RTCRayHit8;
    static constexpr auto occluded = rtcOccluded8;
    static constexpr auto intersect = rtcIntersect8;
};

/// Weight of a cosine-weighted sample: the kernel's density over (n.w) / pi.
float sample_weight(Kernel kernel, float cosine)
{
    if (kernel == Kernel::cosine)
        return 1.0f;
    return cosine <= 0.25f ? 2.0f : 0.5f / cosine;  // min(1, 4 cosine) / (2 cosine)
}

/// What the rays of a packet have found, lane by lane.
struct LaneSums {
    float hits[kPacket] = {};                                 ///< weighted
    float x[kPacket] = {}, y[kPacket] = {}, z[kPacket] = {};  ///< weighted open directions
};

/// Traces kPacket rays in Embree packets of `width`.
template <int width>
class PacketTracer {
public:
    PacketTracer(RTCScene scene, const Definition& definition)
        : scene_(scene), definition_(definition)
    {
        rtcInitIntersectContext(&context_);
        context_.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        for (auto& part : rays_) {
            for (int lane = 0; lane < width; ++lane) {
                part.ray.tnear[lane] = 0.0f;
                part.ray.time[lane] = 0.0f;
                part.ray.mask[lane] = ~0u;
                part.ray.id[lane] = 0;
                part.ray.flags[lane] = 0;
            }
        }
    }

    void set_origin(int lane, glm::vec3 position)
    {
        auto& ray = rays_[lane / width].ray;
        ray.org_x[lane % width] = position.x;
        ray.org_y[lane % width] = position.y;
        ray.org_z[lane % width] = position.z;
        if (definition_.ground)
            above_[lane] = glm::dot(definition_.ground->up, position) - definition_.ground->height;
    }

    /// valid[lane] is -1 where there is a ray, else 0.
    void trace(const DirectionPacket& directions, const int (&valid)[kPacket], LaneSums& sums)
    {
        for (int first = 0; first < kPacket; first += width)
            trace_part(directions, first, valid + first, sums);
    }

private:
    /// Rays that reach the ground end there. Where its distance does not count they need not be
    /// traced.
    template <class Rays>
    void end_at_ground(Rays& ray, const float* above, int* mask, bool* on_ground) const
    {
        const glm::vec3 up = definition_.ground->up;
        for (int lane = 0; lane < width; ++lane) {
            const float rise =
                ray.dir_x[lane] * up.x + ray.dir_y[lane] * up.y + ray.dir_z[lane] * up.z;
            const bool meets = above[lane] >= 0.0f ? rise < 0.0f : rise > 0.0f;
            if (!meets || !(-above[lane] / rise < ray.tfar[lane]))
                continue;
            ray.tfar[lane] = -above[lane] / rise;
            on_ground[lane] = true;
            if (definition_.falloff == Falloff::none)
                mask[lane] = 0;
        }
    }

    void trace_part(const DirectionPacket& directions, int first, const int* valid, LaneSums& sums)
    {
        auto& part = rays_[first / width];
        for (int lane = 0; lane < width; ++lane) {
            part.ray.dir_x[lane] = directions.x[first + lane];
            part.ray.dir_y[lane] = directions.y[first + lane];
            part.ray.dir_z[lane] = directions.z[first + lane];
            part.ray.tfar[lane] = definition_.max_distance;
        }
        alignas(64) int mask[width];
        std::copy_n(valid, width, mask);
        bool on_ground[width] = {};
        if (definition_.ground)
            end_at_ground(part.ray, above_ + first, mask, on_ground);

        // any hit is as good as another unless its distance counts
        float hit[width];
        if (definition_.falloff == Falloff::none) {
            Packets<width>::occluded(mask, scene_, &context_, &part.ray);
            for (int lane = 0; lane < width; ++lane)
                hit[lane] = part.ray.tfar[lane] < 0.0f || on_ground[lane] ? 1.0f : 0.0f;
            // tfar: Embree's mark, -infinity
        } else {
            std::fill_n(part.hit.geomID, width, RTC_INVALID_GEOMETRY_ID);
            Packets<width>::intersect(mask, scene_, &context_, &part);
            for (int lane = 0; lane < width; ++lane)
                hit[lane] = hit_weight(definition_, part.ray.tfar[lane]);  // 0 where it missed
        }

        for (int lane = 0; lane < width; ++lane) {
            const float weight =
                valid[lane] ? sample_weight(definition_.kernel, directions.cosine[first + lane])
                            : 0.0f;
            const float open = weight * (1.0f - hit[lane]);
            sums.hits[first + lane] += weight * hit[lane];
            sums.x[first + lane] += open * part.ray.dir_x[lane];
            sums.y[first + lane] += open * part.ray.dir_y[lane];
            sums.z[first + lane] += open * part.ray.dir_z[lane];
        }
    }

    RTCScene scene_;
    Definition definition_;
    RTCIntersectContext context_;
    float above_[kPacket] = {};  ///< the ground, signed
    typename Packets<width>::RayHit rays_[kPacket / width] = {};
};

Occlusion answer(float hits, glm::vec3 open, const Receiver& receiver, std::uint32_t rays)
{
    const float length = glm::length(open);
    return {std::min(1.0f, hits / static_cast<float>(rays)),
            length > 0.0f ? open / length : receiver.normal};
}

/// Receivers along a Morton curve: neighbours see the same part of the hierarchy.
std::vector<std::uint32_t> morton_order(std::span<const Receiver> receivers)
{
    const auto spread = [](float x) {  // 10 bits of the unit frame (half a diagonal and a margin)
        std::uint32_t bits =
            static_cast<std::uint32_t>(std::clamp((x + 0.5f) * 1024.0f, 0.0f, 1023.0f));
        bits = (bits | bits << 16) & 0x030000FFu;
        bits = (bits | bits << 8) & 0x0300F00Fu;
        bits = (bits | bits << 4) & 0x030C30C3u;
        return (bits | bits << 2) & 0x09249249u;
    };
    std::vector<std::uint64_t> keys(receivers.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const glm::vec3 p = receivers[i].position;
        const std::uint32_t code = spread(p.x) << 2 | spread(p.y) << 1 | spread(p.z);
        keys[i] = static_cast<std::uint64_t>(code) << 32 | i;
    }
    tbb::parallel_sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(),
                   [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
    return order;
}

/// The work on one fixed run of at most kPacket neighbouring receivers. Runs do not depend on the
/// number of threads, and so neither does any packet.
template <int width>
class RunTracer {
public:
    RunTracer(RTCScene scene, std::span<const Receiver> receivers, const RayOptions& options,
              const SobolPoints& points, std::vector<Occlusion>& results)
        : receivers_(receivers),
          options_(options),
          points_(points),
          results_(results),
          tracer_(scene, options.definition)
    {
    }

    void trace(std::span<const std::uint32_t> run)
    {
        if (options_.rays < kPacket) {
            trace_across(run);
        } else {
            for (const std::uint32_t index : run)
                trace_receiver(index);
        }
    }

private:
    /// Packets of rays of one receiver.
    void trace_receiver(std::uint32_t index)
    {
        const Receiver& receiver = receivers_[index];
        if (receiver.normal == glm::vec3(0.0f))
            return;
        const Hemisphere hemisphere = hemisphere_over(receiver.normal, options_.seed, index);
        for (int lane = 0; lane < kPacket; ++lane)
            tracer_.set_origin(lane, receiver.position);
        LaneSums sums;
        for (std::uint32_t first = 0; first < options_.rays; first += kPacket) {
            int valid[kPacket];
            for (int lane = 0; lane < kPacket; ++lane)
                valid[lane] = first + static_cast<std::uint32_t>(lane) < options_.rays ? -1 : 0;
            fill_directions(points_, first, hemisphere, directions_);
            tracer_.trace(directions_, valid, sums);
        }
        float hits = 0.0f;
        glm::vec3 open(0.0f);
        for (int lane = 0; lane < kPacket; ++lane) {
            hits += sums.hits[lane];
            open += glm::vec3(sums.x[lane], sums.y[lane], sums.z[lane]);
        }
        results_[index] = answer(hits, open, receiver, options_.rays);
    }

    /// Packets of one ray each of neighbouring receivers.
    void trace_across(std::span<const std::uint32_t> run)
    {
        Hemisphere hemispheres[kPacket];
        int valid[kPacket] = {};
        for (std::size_t lane = 0; lane < run.size(); ++lane) {
            const Receiver& receiver = receivers_[run[lane]];
            hemispheres[lane] = hemisphere_over(receiver.normal, options_.seed, run[lane]);
            valid[lane] = receiver.normal == glm::vec3(0.0f) ? 0 : -1;
            tracer_.set_origin(static_cast<int>(lane), receiver.position);
        }
        LaneSums sums;
        for (std::uint32_t ray = 0; ray < options_.rays; ++ray) {
            fill_directions_across(points_, ray, hemispheres, directions_);
            tracer_.trace(directions_, valid, sums);
        }
        for (std::size_t lane = 0; lane < run.size(); ++lane) {
            if (valid[lane])
                results_[run[lane]] =
                    answer(sums.hits[lane], {sums.x[lane], sums.y[lane], sums.z[lane]},
                           receivers_[run[lane]], options_.rays);
        }
    }

    std::span<const Receiver> receivers_;
    const RayOptions& options_;
    const SobolPoints& points_;
    std::vector<Occlusion>& results_;
    PacketTracer<width> tracer_;
    DirectionPacket directions_;
};

template <int width>
std::vector<Occlusion> trace_all(RTCScene scene, std::span<const Receiver> receivers,
                                 const RayOptions& options, const Progress& progress)
{
    const SobolPoints points = sobol_points_by_cell(options.rays);
    const std::vector<std::uint32_t> order = morton_order(receivers);
    std::vector<Occlusion> results(receivers.size());
    const std::size_t run_count = (order.size() + kPacket - 1) / kPacket;
    const ShareRange share = range_of(options.share, run_count);
    ProgressMeter meter(progress, std::min(share.end * kPacket, order.size()) -
                                      std::min(share.begin * kPacket, order.size()));
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t run = i / kPacket;
        if ((run < share.begin || run >= share.end) &&
            receivers[order[i]].normal != glm::vec3(0.0f))
            results[order[i]] = kUnsolved;
    }
    for_ranges(share.begin, share.end, 4, [&](std::size_t begin, std::size_t end) {
        const FlushDenormals flush;
        RunTracer<width> tracer(scene, receivers, options, points, results);
        for (std::size_t run = begin; run < end; ++run) {
            const std::size_t first = run * kPacket;
            const std::size_t count = std::min<std::size_t>(kPacket, order.size() - first);
            tracer.trace(std::span(order).subspan(first, count));
            meter.add(count);
        }
    });
    return results;
}

}  // namespace

RayScene::RayScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl))
{
}

RayScene::RayScene(const Geometry& geometry, Build build, Isa isa)
{
    keep_floating_point_mode();
    const RTCDevice device = device_for(isa);
    impl_ = std::make_unique<Impl>(device, build, false);
    if (!geometry.triangles.empty()) {
        const EmbreeMesh mesh =
            new_mesh(device, geometry.positions.size(), geometry.triangles.size());
        std::ranges::copy(geometry.positions, mesh.vertices);
        std::ranges::copy(geometry.triangles, mesh.triangles);
        rtcSetGeometryBuildQuality(mesh.geometry, build == Build::quick ? RTC_BUILD_QUALITY_LOW
                                                                        : RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(mesh.geometry);
        rtcAttachGeometry(impl_->scene, mesh.geometry);
        rtcReleaseGeometry(mesh.geometry);
    }
    rtcCommitScene(impl_->scene);
    check_device(device);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::vector<Occlusion> trace_occlusion(const RayScene& scene, std::span<const Receiver> receivers,
                                       const RayOptions& options, const Progress& progress)
{
    check_definition(options.definition);
    require(options.rays >= 1 && options.rays <= kMostRays,
            "rays must be between 1 and " + std::to_string(kMostRays));
    const RayScene::Impl& impl = scene.impl();
    return impl.wide ? trace_all<16>(impl.scene, receivers, options, progress)
                     : trace_all<8>(impl.scene, receivers, options, progress);
}

std::vector<ClosestHit> closest_hits(const RayScene& scene, std::span<const Ray> rays)
{
    std::vector<ClosestHit> hits(rays.size());
    for_ranges(0, rays.size(), 1024, [&](std::size_t begin, std::size_t end) {
        const FlushDenormals flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (std::size_t i = begin; i < end; ++i) {
            const Ray& ray = rays[i];
            RTCRayHit query{};
            query.ray.org_x = ray.origin.x;
            query.ray.org_y = ray.origin.y;
            query.ray.org_z = ray.origin.z;
            query.ray.dir_x = ray.direction.x;
            query.ray.dir_y = ray.direction.y;
            query.ray.dir_z = ray.direction.z;
            query.ray.tfar = ray.length;
            query.ray.mask = ~0u;
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene.impl().scene, &context, &query);
            if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
                continue;
            const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
            hits[i] = {query.hit.primID,
                       {query.hit.u, query.hit.v},
                       query.ray.tfar,
                       glm::dot(normal, ray.direction) > 0.0f};
        }
    });
    return hits;
}

namespace {

glm::vec3 nearest_of_triangle(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    const glm::vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return a;
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0f && d4 <= d3)
        return b;
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
        return a + d1 / (d1 - d3) * ab;
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0f && d5 <= d6)
        return c;
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
        return a + d2 / (d2 - d6) * ac;
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 >= d3 && d5 >= d6)
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

/// What a point query carries with it.
struct NearestQuery {
    const Geometry& geometry;
    glm::vec3 place;
    NearestPlace found;
};

/// Looks at a triangle; whether the search may be narrowed.
bool look_at_triangle(RTCPointQueryFunctionArguments* arguments)
{
    auto& query = *static_cast<NearestQuery*>(arguments->userPtr);
    const glm::uvec3 t = query.geometry.triangles[arguments->primID];
    const std::vector<glm::vec3>& at = query.geometry.positions;
    const glm::vec3 position = nearest_of_triangle(query.place, at[t.x], at[t.y], at[t.z]);
    const float distance = glm::distance(position, query.place);
    constexpr float kAsNear = 1.0f + 1e-6f;
    NearestPlace& best = query.found;
    const bool is_first = best.triangle == ClosestHit::kNone;
    if (!is_first && (distance > kAsNear * best.distance ||
                      (kAsNear * distance >= best.distance && arguments->primID > best.triangle)))
        return false;
    best = {arguments->primID, position, distance};
    if (!(kAsNear * distance < arguments->query->radius))
        return false;
    arguments->query->radius = kAsNear * distance;  // those as near are looked at too
    return true;
}

}  // namespace

std::vector<NearestPlace> nearest_places(const RayScene& scene, const Geometry& geometry,
                                         std::span<const glm::vec3> places)
{
    std::vector<NearestPlace> found(places.size());
    for_all(places.size(), 64, [&](std::size_t i) {
        NearestQuery nearest{geometry, places[i], {}};
        RTCPointQuery query{};
        query.x = places[i].x;
        query.y = places[i].y;
        query.z = places[i].z;
        query.radius = std::numeric_limits<float>::infinity();
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene.impl().scene, &query, &context, look_at_triangle, &nearest);
        found[i] = nearest.found;
    });
    return found;
}

}  // namespace surfelao
