#include "bake/vertex_target.h"

#include "surfels/errors.h"
#include "surfels/number_text.h"
#include "tree/discard.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace surfelao {
namespace {

/// Samples: 12 MiB, and 28 MiB of receivers.
constexpr std::size_t kFoldedAtOnce = std::size_t{1} << 20;

}  // namespace

Offset offset_of(const TargetSettings& settings, const Frame& frame)
{
    if (!settings.offset)
        return {};
    const Length& length = *settings.offset;
    require(length.value > 0.0, "offset must be above 0");
    const double share = length.percent ? length.value / 100.0 : length.value / frame.diagonal;
    const auto offset = static_cast<float>(share);
    if (!(offset > 0.0f) || !(share < 1.0))
        throw InputError("the offset must be smaller than the scene, whose size is " +
                         std::to_string(frame.diagonal) + ", and not vanish beside it");
    return offset;
}

float largest_offset_of(const TargetSettings& settings, const Frame& frame)
{
    return offset_of(settings, frame).value_or(kMostOffset);
}

std::string name_of(NormalSource source)
{
    switch (source) {
        case NormalSource::automatic:
            return "auto";
        case NormalSource::file:
            return "file";
        case NormalSource::smooth:
            return "smooth";
        case NormalSource::flat:
            return "flat";
        case NormalSource::up:
            return "up";
    }
    throw SettingsError("normals must be auto, file, smooth or flat");
}

std::string name_of(VertexValues values)
{
    return values == VertexValues::fit ? "fit" : "point";
}

std::string text_of(const TargetSettings& settings)
{
    std::string text = "normals=" + name_of(settings.normals.source);
    append_shortest(text += " crease=", settings.normals.crease);
    text += " values=" + name_of(settings.values);
    if (settings.offset) {
        append_shortest(text += " offset=", settings.offset->value);
        text += settings.offset->percent ? "%" : "";
    }
    if (settings.viewpoint) {
        append_shortest(text += " viewpoint=", settings.viewpoint->x);
        append_shortest(text += ":", settings.viewpoint->y);
        append_shortest(text += ":", settings.viewpoint->z);
    }
    if (settings.sky && settings.normals.source == NormalSource::up)
        text += settings.sky->y != 0.0f ? " sky=y" : " sky=z";
    if (settings.occluder_spacing) {
        append_shortest(text += " occluder-spacing=", settings.occluder_spacing->value);
        text += settings.occluder_spacing->percent ? "%" : "";
    }
    return text;
}

VertexTarget::VertexTarget(std::shared_ptr<const Mesh> mesh, const TargetSettings& settings,
                           bool is_folded)
    : mesh_(std::move(mesh)), settings_(settings)
{
    const Surface& surface = mesh_->surface;
    if (settings.values == VertexValues::fit) {
        fit_.emplace(mesh_->geometry, surface, settings.normals);
        for (const std::uint32_t vertex : fit_->unused_vertices()) {
            if (surface.normals[vertex] != glm::vec3(0.0f))
                lone_.push_back(vertex);
        }
    }
    make_receivers(is_folded);
}

void VertexTarget::follow_mesh()
{
    make_receivers(false);
}

void VertexTarget::make_receivers(bool folds)
{
    const Geometry& geometry = mesh_->geometry;
    const Surface& surface = mesh_->surface;
    const Offset offset = offset_of(settings_, geometry.frame);
    if (!fit_) {
        receivers_ = receivers_at_wedges(geometry, surface, offset);
        return;
    }
    const std::span<const SurfacePoint> points = fit_->samples().points;
    receivers_.clear();
    receivers_.reserve(points.size() + lone_.size());
    const std::size_t count = points.size();
    std::size_t end = 0;
    do {
        const std::size_t first = end;
        end = std::min(first + kFoldedAtOnce, count);
        receivers_.resize(end);
        receivers_at(geometry, surface, points.subspan(first, end - first), offset,
                     std::span(receivers_).subspan(first));
        if (folds)
            fit_->fold(first, end);
    } while (end < count);
    for (const std::uint32_t vertex : lone_) {
        const glm::vec3 normal = surface.normals[vertex];
        const float height = offset.value_or(kMostOffset);
        receivers_.push_back({geometry.positions[vertex] + height * normal, normal, height});
    }
}

void VertexTarget::forget_receivers(std::size_t first, std::size_t end)
{
    if (end == receivers_.size())
        receivers_ = std::vector<Receiver>();  // {} would keep the room
    else
        discard(std::span(receivers_).subspan(first, end - first));
}

void VertexTarget::unfold()
{
    if (fit_)
        fit_->unfold();
}

std::vector<Occlusion> VertexTarget::with_lone(std::vector<Occlusion> values,
                                               std::span<const Occlusion> answers) const
{
    for (std::size_t i = 0; i < lone_.size(); ++i)
        values[lone_[i]] = answers[answers.size() - lone_.size() + i];
    return values;
}

std::vector<Occlusion> VertexTarget::values(std::span<const Occlusion> answers) const
{
    if (!fit_)
        return mean_of_wedges(answers);
    return with_lone(fit_->solve(answers.first(answers.size() - lone_.size())), answers);
}

std::vector<Occlusion> VertexTarget::values_locally(std::span<const Occlusion> answers) const
{
    if (!fit_)
        return mean_of_wedges(answers);
    return with_lone(fit_->solve_locally(answers.first(answers.size() - lone_.size())), answers);
}

/// Of the samples in each triangle.
struct VertexTarget::Residuals {
    std::vector<double> squares;  ///< summed
    std::vector<std::uint32_t> counts;

    [[nodiscard]] double mean_square(std::size_t triangle) const
    {
        return counts[triangle] > 0 ? squares[triangle] / counts[triangle] : 0.0;
    }
};

VertexTarget::Residuals VertexTarget::residuals(std::span<const Occlusion> answers,
                                                std::span<const Occlusion> values) const
{
    const std::size_t triangles = mesh_->geometry.triangles.size();
    Residuals residuals{std::vector<double>(triangles, 0.0),
                        std::vector<std::uint32_t>(triangles, 0)};
    if (!fit_)
        return residuals;
    const std::vector<SurfacePoint>& points = fit_->samples().points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double error = answers[i].occlusion - displayed(mesh_->geometry, values, points[i]);
        residuals.squares[points[i].triangle] += error * error;
        ++residuals.counts[points[i].triangle];
    }
    return residuals;
}

std::optional<Misfit> VertexTarget::misfit(std::span<const Occlusion> answers,
                                           std::span<const Occlusion> values) const
{
    const Residuals found = residuals(answers, values);
    const std::vector<double> areas = triangle_areas(mesh_->geometry);
    double sum = 0.0, coarse = 0.0, whole = 0.0;
    for (std::size_t t = 0; t < areas.size(); ++t) {
        if (found.counts[t] == 0)
            continue;
        const double square = found.mean_square(t);
        sum += areas[t] * square;
        coarse += found.counts[t] > 1 && square > kCoarse * kCoarse ? areas[t] : 0.0;
        whole += areas[t];
    }
    if (!(whole > 0.0))
        return {};
    return Misfit{std::sqrt(sum / whole), coarse / whole, whole};
}

std::vector<float> VertexTarget::triangle_misfits(std::span<const Occlusion> answers,
                                                  std::span<const Occlusion> values) const
{
    const Residuals found = residuals(answers, values);
    std::vector<float> misfits;
    misfits.reserve(found.counts.size());
    for (std::size_t t = 0; t < found.counts.size(); ++t)
        misfits.push_back(static_cast<float>(std::sqrt(found.mean_square(t))));
    return misfits;
}

std::vector<Occlusion> VertexTarget::mean_of_wedges(std::span<const Occlusion> answers) const
{
    const Surface& surface = mesh_->surface;
    const std::size_t vertices = surface.vertex_count();
    std::vector<Occlusion> values(answers.begin(),
                                  answers.begin() + static_cast<std::ptrdiff_t>(vertices));
    if (answers.size() == vertices)
        return values;
    const std::vector<float> angles = angles_of_wedges(mesh_->geometry, surface);
    std::vector<float> weights(vertices, 0.0f), sums(vertices, 0.0f);
    std::vector<glm::vec3> bent(vertices, glm::vec3(0.0f));
    for (std::uint32_t wedge = 0; wedge < answers.size(); ++wedge) {
        const std::uint32_t vertex = surface.vertex_of(wedge);
        const float visibility = 1.0f - answers[wedge].occlusion;
        weights[vertex] += angles[wedge];
        sums[vertex] += angles[wedge] * answers[wedge].occlusion;
        bent[vertex] += angles[wedge] * visibility * answers[wedge].bent_normal;
    }
    for (const std::uint32_t vertex : surface.extra_vertices) {
        if (!(weights[vertex] > 0.0f))
            continue;
        values[vertex].occlusion = sums[vertex] / weights[vertex];
        const float length = glm::length(bent[vertex]);
        if (length > kLeastBent * weights[vertex])
            values[vertex].bent_normal = bent[vertex] / length;
    }
    return values;
}

float displayed(const Geometry& geometry, std::span<const Occlusion> values,
                const SurfacePoint& point)
{
    const glm::uvec3 t = geometry.triangles[point.triangle];
    return (1.0f - point.at.x - point.at.y) * values[t.x].occlusion +
           point.at.x * values[t.y].occlusion + point.at.y * values[t.z].occlusion;
}

}  // namespace surfelao
