#include "engines/moving.h"

#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <utility>

namespace surfelao {

glm::dmat4 matrix_of(const Placement& placement)
{
    glm::dmat4 matrix(placement.scale * placement.rotation);
    matrix[3] = glm::dvec4(placement.translation, 1.0);
    return matrix;
}

std::optional<Placement> placement_of(const glm::dmat4& matrix)
{
    constexpr double kEven = 1e-6;
    const glm::dmat3 linear(matrix);
    const double scale = glm::length(linear[0]);
    if (!(scale > 0.0) || !std::isfinite(scale))
        return std::nullopt;
    Placement placement;
    placement.scale = scale;
    placement.rotation = linear / scale;
    placement.translation = glm::dvec3(matrix[3]);
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(placement.translation[i]))
            return std::nullopt;
        for (int j = 0; j < 3; ++j) {
            const double product = glm::dot(placement.rotation[i], placement.rotation[j]);
            if (!(std::abs(product - (i == j ? 1.0 : 0.0)) <= kEven))
                return std::nullopt;
        }
    }
    return placement;
}

Receiver placed(const Receiver& receiver, const Placement& placement)
{
    const glm::dvec3 normal = placement.rotation * glm::dvec3(receiver.normal);
    const double length = glm::length(normal);
    return {glm::vec3(placement.scale * (placement.rotation * glm::dvec3(receiver.position)) +
                      placement.translation),
            length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f),
            static_cast<float>(placement.scale * receiver.offset)};
}

/// All bodies in one geometry, which is prepared again whenever one of them has moved.
struct MovingScene::Impl {
    Geometry at_rest;
    std::vector<std::uint32_t> body_of_triangle;
    EngineChoice choice;
    std::vector<std::optional<Placement>> placements;          ///< empty: hidden
    std::vector<std::optional<std::vector<glm::vec3>>> forms;  ///< of deformed bodies
    std::optional<Prepared> prepared;
    std::uint64_t version = 0;

    void change()
    {
        ++version;
        prepared.reset();
    }

    const Prepared& now()
    {
        if (prepared)
            return *prepared;
        Geometry geometry = at_rest;
        geometry.triangles.clear();
        for (std::size_t t = 0; t < at_rest.triangles.size(); ++t) {
            const std::uint32_t body = body_of_triangle[t];
            if (!placements[body])
                continue;
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = at_rest.triangles[t][corner];
                const glm::vec3 p =
                    forms[body] ? (*forms[body])[vertex] : at_rest.positions[vertex];
                geometry.positions[vertex] =
                    body == 0 ? p : placed({p, {}, 0.0f}, *placements[body]).position;
            }
            geometry.triangles.push_back(at_rest.triangles[t]);
        }
        prepared.emplace(prepare(geometry, choice));
        return *prepared;
    }
};

MovingScene::MovingScene(const Geometry& geometry, std::span<const std::uint32_t> body_of_triangle,
                         const EngineChoice& choice)
    : impl_(std::make_unique<Impl>())
{
    require(choice.device == Device::cpu, "moving scenes are solved on the CPU");
    require(body_of_triangle.size() == geometry.triangles.size(),
            "every triangle must belong to a body");
    impl_->at_rest = geometry;
    impl_->body_of_triangle.assign(body_of_triangle.begin(), body_of_triangle.end());
    impl_->choice = choice;
    std::uint32_t bodies = 1;
    for (const std::uint32_t body : body_of_triangle)
        bodies = std::max(bodies, body + 1);
    impl_->placements.assign(bodies, Placement{});
    impl_->forms.resize(bodies);
}
MovingScene::~MovingScene() = default;
MovingScene::MovingScene(MovingScene&&) noexcept = default;
MovingScene& MovingScene::operator=(MovingScene&&) noexcept = default;

std::uint32_t MovingScene::body_count() const
{
    return static_cast<std::uint32_t>(impl_->placements.size());
}

const EngineChoice& MovingScene::choice() const
{
    return impl_->choice;
}

void MovingScene::place(std::uint32_t body, const Placement& placement)
{
    require(body >= 1 && body < body_count(), "there is no such body");
    impl_->placements[body] = placement;
    impl_->forms[body].reset();
    impl_->change();
}

void MovingScene::hide(std::uint32_t body)
{
    require(body >= 1 && body < body_count(), "there is no such body");
    impl_->placements[body].reset();
    impl_->change();
}

void MovingScene::deform(std::uint32_t body, std::span<const glm::vec3> positions)
{
    require(body >= 1 && body < body_count(), "there is no such body");
    require(positions.size() == impl_->at_rest.positions.size(), "one position per vertex");
    impl_->placements[body] = Placement{};
    impl_->forms[body].emplace(positions.begin(), positions.end());
    impl_->change();
}

Solution MovingScene::solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                            const Progress& progress) const
{
    return surfelao::solve(impl_->now(), receivers, settings, progress);
}

struct MovingReceivers::Impl {
    const MovingScene* scene = nullptr;
    MovingSettings settings;
    std::vector<Receiver> at_rest, now;
    std::vector<std::uint32_t> body_of_receiver;
    std::vector<Occlusion> occlusion;
};

MovingReceivers::MovingReceivers(const MovingScene& scene, std::vector<Receiver> at_rest,
                                 std::vector<std::uint32_t> body_of_receiver,
                                 const MovingSettings& settings)
    : impl_(std::make_unique<Impl>())
{
    check_settings(scene.choice(), settings);
    require(settings.tolerance >= 0.0f, "the tolerance must be 0 or more");
    require(body_of_receiver.size() == at_rest.size(), "every receiver must belong to a body");
    impl_->scene = &scene;
    impl_->settings = settings;
    impl_->now = at_rest;
    impl_->at_rest = std::move(at_rest);
    impl_->body_of_receiver = std::move(body_of_receiver);
    impl_->occlusion.resize(impl_->now.size());
}
MovingReceivers::~MovingReceivers() = default;
MovingReceivers::MovingReceivers(MovingReceivers&&) noexcept = default;
MovingReceivers& MovingReceivers::operator=(MovingReceivers&&) noexcept = default;

void MovingReceivers::deform(std::uint32_t body, std::span<const Receiver> receivers)
{
    std::size_t next = 0;
    for (std::size_t i = 0; i < impl_->at_rest.size(); ++i) {
        if (impl_->body_of_receiver[i] != body)
            continue;
        require(next < receivers.size(), "one receiver for each of the body's");
        impl_->at_rest[i] = receivers[next++];
    }
    require(next == receivers.size(), "one receiver for each of the body's");
}

FrameReport MovingReceivers::solve(const Progress& progress)
{
    FrameReport report;
    Stopwatch watch;
    const auto& placements = impl_->scene->impl().placements;
    for (std::size_t i = 0; i < impl_->now.size(); ++i) {
        const std::uint32_t body = impl_->body_of_receiver[i];
        if (body != 0 && placements[body])
            impl_->now[i] = placed(impl_->at_rest[i], *placements[body]);
    }
    report.place = watch.lap();
    const Prepared& prepared = impl_->scene->impl().now();
    report.tree = watch.lap();
    std::vector<Occlusion> found =
        surfelao::solve(prepared, impl_->now, impl_->settings, progress).occlusion;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (placements[impl_->body_of_receiver[i]])
            impl_->occlusion[i] = found[i];
    }
    report.solve = watch.lap();
    report.solved = found.size();
    return report;
}

const std::vector<Occlusion>& MovingReceivers::occlusion() const
{
    return impl_->occlusion;
}

const std::vector<Receiver>& MovingReceivers::receivers() const
{
    return impl_->now;
}

}  // namespace surfelao
