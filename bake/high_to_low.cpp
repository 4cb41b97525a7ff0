#include "bake/high_to_low.h"

#include "reference/closest_hit.h"
#include "surfels/errors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace surfelao {
namespace {

/// Back sides that a ray passes before the first one is taken.
constexpr int kMostBackSides = 8;

std::string name_of_part(const Scene& scene, const Part& part)
{
    std::string name =
        part.name.empty() ? std::filesystem::path(scene.name).stem().string() : part.name;
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name;
}

/// "NAME" of "NAME_low"; empty for others.
std::string low_stem(const std::string& name)
{
    constexpr std::string_view kLow = "_low";
    return name.ends_with(kLow) ? name.substr(0, name.size() - kLow.size()) : "";
}

/// The geometry with some of its triangles.
Geometry with_triangles(const Geometry& geometry, const std::vector<std::uint32_t>& triangles)
{
    Geometry some;
    some.frame = geometry.frame;
    some.positions = geometry.positions;
    for (const std::uint32_t triangle : triangles)
        some.triangles.push_back(geometry.triangles[triangle]);
    return some;
}

glm::dvec3 to_world(const Frame& frame, glm::vec3 unit)
{
    return frame.centre + frame.diagonal * glm::dvec3(unit);
}

glm::vec3 to_unit(const Frame& frame, glm::dvec3 world)
{
    return glm::vec3((world - frame.centre) / frame.diagonal);
}

/// The receiver on the other side of its triangle.
Receiver turned(const Receiver& receiver, const Geometry& geometry, std::uint32_t triangle)
{
    const glm::uvec3 v = geometry.triangles[triangle];
    const glm::vec3 a = geometry.positions[v.x];
    glm::vec3 normal =
        glm::normalize(glm::cross(geometry.positions[v.y] - a, geometry.positions[v.z] - a));
    if (glm::dot(normal, receiver.normal) < 0.0f)
        normal = -normal;
    return {receiver.position - 2.0f * receiver.offset * normal, -receiver.normal, receiver.offset};
}

}  // namespace

/// High parts that one or several low parts look for.
struct HighDetail::Group {
    RayScene rays;
    std::vector<std::uint32_t> triangles;  ///< of the high geometry; empty: all

    /// What the rays show; kNone where nothing is met.
    [[nodiscard]] std::vector<ClosestHit> look(std::vector<Ray> looks) const
    {
        std::vector<ClosestHit> found = closest_hits(rays, looks), next = found;
        for (int round = 0; round < kMostBackSides; ++round) {
            std::vector<std::size_t> behind;
            std::vector<Ray> further;
            for (std::size_t i = 0; i < looks.size(); ++i) {
                if (next[i].triangle == ClosestHit::kNone || !next[i].is_back)
                    continue;
                const float passed = next[i].distance + kPast;
                looks[i].origin += passed * looks[i].direction;
                looks[i].length -= passed;
                next[i] = {};
                if (looks[i].length > 0.0f) {
                    behind.push_back(i);
                    further.push_back(looks[i]);
                }
            }
            if (behind.empty())
                break;
            const std::vector<ClosestHit> hits = closest_hits(rays, further);
            for (std::size_t k = 0; k < behind.size(); ++k) {
                next[behind[k]] = hits[k];
                if (hits[k].triangle != ClosestHit::kNone && !hits[k].is_back)
                    found[behind[k]] = hits[k];
            }
        }
        if (!triangles.empty())
            for (ClosestHit& hit : found)
                if (hit.triangle != ClosestHit::kNone)
                    hit.triangle = triangles[hit.triangle];
        return found;
    }

    /// In diagonals: behind a hit, so that it is not met again.
    static constexpr float kPast = 1e-6f;
};

HighDetail::HighDetail(const Mesh& low, const Mesh& high, double cage)
    : low_(low), high_(high), cage_(cage)
{
    require(std::isfinite(cage) && cage > 0.0, "the cage must be above 0");
    std::vector<std::uint32_t> part_of_high(high.scene.triangles.size(), 0);
    std::vector<std::string> names;
    for (std::uint32_t p = 0; p < high.scene.parts.size(); ++p) {
        const Part& part = high.scene.parts[p];
        names.push_back(name_of_part(high.scene, part));
        std::fill_n(part_of_high.begin() + part.first_triangle, part.triangle_count, p);
    }
    groups_.push_back(
        std::make_unique<Group>(Group{RayScene(high.geometry, RayScene::Build::robust), {}}));
    std::map<std::string, std::uint32_t> group_of_stem;
    std::vector<std::uint32_t> group_of_scene(low.scene.triangles.size(), 0);
    for (const Part& part : low.scene.parts) {
        const std::string stem = low_stem(name_of_part(low.scene, part));
        if (stem.empty())
            continue;
        if (!group_of_stem.contains(stem)) {
            std::vector<std::uint32_t> triangles;
            for (std::uint32_t t = 0; t < high.geometry.triangles.size(); ++t)
                if (names[part_of_high[high.geometry.scene_triangle(t)]].starts_with(stem +
                                                                                     "_high"))
                    triangles.push_back(t);
            group_of_stem[stem] =
                triangles.empty() ? 0 : static_cast<std::uint32_t>(groups_.size());
            if (!triangles.empty()) {
                RayScene rays(with_triangles(high.geometry, triangles), RayScene::Build::robust);
                groups_.push_back(
                    std::make_unique<Group>(Group{std::move(rays), std::move(triangles)}));
            }
        }
        const std::uint32_t group = group_of_stem[stem];
        std::fill_n(group_of_scene.begin() + part.first_triangle, part.triangle_count, group);
        matched_parts_ += group > 0 ? 1 : 0;
    }
    for (std::size_t t = 0; t < low.geometry.triangles.size(); ++t)
        group_of_.push_back(group_of_scene[low.geometry.scene_triangle(t)]);
}

HighDetail::~HighDetail() = default;

std::vector<Receiver> HighDetail::receivers(std::span<const SurfacePoint> low_points,
                                            const Offset& offset, std::uint64_t* misses) const
{
    const Frame& frame = high_.geometry.frame;
    const auto reach = static_cast<float>(cage_ / frame.diagonal);
    std::vector<Receiver> list = receivers_at(low_.geometry, low_.surface, low_points, offset);
    std::vector<std::vector<Ray>> looks(groups_.size());
    std::vector<std::vector<std::size_t>> whose(groups_.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        Receiver& receiver = list[i];
        receiver.position = to_unit(frame, to_world(low_.geometry.frame, receiver.position));
        if (receiver.normal == glm::vec3(0.0f))
            continue;
        const std::uint32_t group = group_of_[low_points[i].triangle];
        looks[group].push_back(
            {receiver.position + reach * receiver.normal, -receiver.normal, 2.0f * reach});
        whose[group].push_back(i);
    }
    for (std::size_t group = 0; group < groups_.size(); ++group) {
        const std::vector<ClosestHit> hits = groups_[group]->look(looks[group]);
        std::vector<SurfacePoint> points;
        std::vector<std::size_t> met;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            if (hits[k].triangle == ClosestHit::kNone)
                continue;
            points.push_back({hits[k].triangle, hits[k].at});
            met.push_back(k);
        }
        const std::vector<Receiver> shown =
            receivers_at(high_.geometry, high_.surface, points, offset);
        for (std::size_t m = 0; m < met.size(); ++m) {
            const ClosestHit& hit = hits[met[m]];
            list[whose[group][met[m]]] =
                hit.is_back ? turned(shown[m], high_.geometry, hit.triangle) : shown[m];
        }
        if (misses)
            *misses += hits.size() - met.size();
    }
    return list;
}

}  // namespace surfelao
