#include "bake/surface_error.h"

#include "bake/hidden_texels.h"
#include "reference/reference_cache.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace surfelao {
namespace {

/// The top 53 bits as a number in [0, 1).
double unit_of(std::uint64_t bits)
{
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// Steele, Lea, Flood. Fast Splittable Pseudorandom Number Generators. 2014
std::uint64_t hash_of(std::uint64_t number)
{
    std::uint64_t bits = (number + 1) * 0x9E3779B97F4A7C15u;
    bits = (bits ^ bits >> 30) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ bits >> 27) * 0x94D049BB133111EBu;
    return bits ^ bits >> 31;
}

/// Even in whichever triangle a run of consecutive numbers falls: the additive recurrence of the
/// plastic number (Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018), folded.
glm::vec2 place_in_triangle(std::uint64_t number)
{
    double u = unit_of(number * 0xC13FA9A902A6328Fu);
    double v = unit_of(number * 0x91E10DA5C79E7B1Du);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    return {static_cast<float>(u), static_cast<float>(v)};
}

/// Nonzero for receivers inside of bodies. occlusion: what is true there, one per receiver.
std::vector<std::uint8_t> hidden_receivers(const Geometry& geometry,
                                           std::span<const Receiver> receivers,
                                           std::span<const Occlusion> occlusion,
                                           const Definition& definition)
{
    std::vector<std::size_t> closed;
    std::vector<Receiver> asked;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (1.0f - occlusion[i].occlusion >= kHiddenVisibility)
            continue;
        closed.push_back(i);
        asked.push_back(receivers[i]);
    }
    const RayScene scene(geometry, RayScene::Build::quick);
    const std::vector<std::uint8_t> inside =
        inside_bodies(geometry, scene, asked, definition.max_distance);
    std::vector<std::uint8_t> hidden(receivers.size(), 0);
    for (std::size_t i = 0; i < closed.size(); ++i)
        hidden[closed[i]] = inside[i];
    return hidden;
}

}  // namespace

std::vector<SurfacePoint> surface_points(const Geometry& geometry, std::uint64_t count)
{
    return surface_points(triangle_areas(geometry), count);
}

std::vector<SurfacePoint> surface_points(std::span<const double> measure, std::uint64_t count)
{
    std::vector<SurfacePoint> points;
    for (const std::uint32_t triangle : stratified(measure, count))
        points.push_back({triangle, place_in_triangle(points.size())});
    return points;
}

std::vector<std::uint32_t> stratified(std::span<const double> measure, std::uint64_t count)
{
    std::vector<std::uint32_t> indices;
    double whole = 0.0;
    for (const double part : measure)
        whole += part;
    if (!(whole > 0.0))
        return indices;
    indices.reserve(count);
    std::uint32_t index = 0;
    const auto last = static_cast<std::uint32_t>(measure.size() - 1);
    double end = measure[0];
    for (std::uint64_t i = 0; i < count; ++i) {
        const double at =
            whole * (static_cast<double>(i) + unit_of(hash_of(i))) / static_cast<double>(count);
        while (at >= end && index < last)
            end += measure[++index];
        indices.push_back(index);
    }
    return indices;
}

SurfaceTruth trace_truth(const Mesh& mesh, const TruthSettings& settings, const Progress& progress)
{
    const std::vector<SurfacePoint> points =
        settings.measure.empty() ? surface_points(mesh.geometry, settings.points)
                                 : surface_points(settings.measure, settings.points);
    const std::vector<Receiver> receivers =
        receivers_at(mesh.geometry, mesh.surface, points, settings.offset);
    const Reference reference =
        trace_reference(mesh.occluding(), receivers,
                        {settings.definition, settings.rays, settings.use_cache}, progress);
    const std::vector<std::uint8_t> hidden =
        settings.leave_out_hidden ? hidden_receivers(mesh.occluding(), receivers,
                                                     reference.occlusion, settings.definition)
                                  : std::vector<std::uint8_t>(receivers.size(), 0);
    SurfaceTruth truth;
    truth.from_cache = reference.from_cache;
    double squares = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!reference.well_defined(i)) {
            ++truth.ill_defined;
            continue;
        }
        if (hidden[i] != 0) {
            ++truth.hidden;
            continue;
        }
        truth.points.push_back(points[i]);
        truth.receivers.push_back(receivers[i]);
        truth.reference.push_back(reference.occlusion[i]);
        const double noise = reference.half_difference[i];
        squares += noise * noise;
    }
    if (!truth.points.empty())
        truth.noise = std::sqrt(squares / static_cast<double>(truth.points.size()));
    return truth;
}

std::vector<Occlusion> displayed_at(const Geometry& geometry, std::span<const Occlusion> values,
                                    std::span<const SurfacePoint> points)
{
    std::vector<Occlusion> shown;
    shown.reserve(points.size());
    for (const SurfacePoint& point : points) {
        const glm::uvec3 t = geometry.triangles[point.triangle];
        const glm::vec3 bent = (1.0f - point.at.x - point.at.y) * values[t.x].bent_normal +
                               point.at.x * values[t.y].bent_normal +
                               point.at.y * values[t.z].bent_normal;
        const float length = glm::length(bent);
        shown.push_back({displayed(geometry, values, point),
                         length > kLeastBent ? bent / length : glm::vec3(0.0f)});
    }
    return shown;
}

ErrorStatistics error_against(const SurfaceTruth& truth, std::span<const Occlusion> answers)
{
    return error_statistics(answers, truth.reference, truth.noise);
}

ErrorStatistics seen_error(const Geometry& geometry, std::span<const Occlusion> values,
                           const SurfaceTruth& truth)
{
    return error_against(truth, displayed_at(geometry, values, truth.points));
}

std::uint32_t floor_rays(std::size_t receivers, std::uint32_t truth_rays)
{
    const double wanted = kFloorRays / static_cast<double>(std::max<std::size_t>(1, receivers));
    const std::uint32_t rays = std::bit_floor(
        static_cast<std::uint32_t>(std::clamp<double>(wanted, kFewestFloorRays, kMostFloorRays)));
    return std::min(rays, truth_rays);
}

Floor find_floor(const VertexTarget& fitted, const Mesh& mesh, const SurfaceTruth& truth,
                 const TruthSettings& settings, const Progress& progress)
{
    const Geometry& geometry = mesh.geometry;
    Floor floor;
    floor.rays = floor_rays(fitted.receivers().size(), settings.rays);
    Reference reference = trace_reference(
        mesh.occluding(), fitted.receivers(),
        {settings.definition, floor.rays, settings.use_cache, /*find_ill_defined=*/false},
        progress);
    floor.from_cache = reference.from_cache;
    floor.values = fitted.values(reference.occlusion);
    floor.displayed = displayed_at(geometry, floor.values, truth.points);

    // the fit of the noise alone: that of one half less that of the mean
    for (std::size_t i = 0; i < reference.occlusion.size(); ++i)
        reference.occlusion[i].occlusion += reference.half_difference[i];
    const std::vector<Occlusion> half = fitted.values(reference.occlusion);
    double squares = 0.0;
    for (std::size_t i = 0; i < truth.points.size(); ++i) {
        const double noise =
            displayed(geometry, half, truth.points[i]) - floor.displayed[i].occlusion;
        squares += noise * noise;
    }
    if (!truth.points.empty())
        floor.noise = std::sqrt(squares / static_cast<double>(truth.points.size()));

    floor.error = error_against(truth, floor.displayed);
    floor.error.rmse = without_noise(floor.error.rmse, floor.noise);
    return floor;
}

double error_beyond(std::span<const Occlusion> displayed, const Floor& floor)
{
    return error_statistics(displayed, floor.displayed, floor.noise).rmse;
}

}  // namespace surfelao
