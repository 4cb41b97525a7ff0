#include "engines/moving.h"

#include "engines/moving_engine.h"
#include "engines/options.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace surfelao {

namespace {

std::unique_ptr<MovingEngine> moving_engine(const Geometry& at_rest, std::vector<BodyMesh> bodies,
                                            const EngineChoice& choice)
{
    switch (choice.engine) {
        case Engine::masks:
            return moving_masks(at_rest, std::move(bodies), choice);
        case Engine::disks:
            return moving_disks(at_rest, std::move(bodies), choice);
        case Engine::rays:
            return moving_rays(at_rest, std::move(bodies), choice);
    }
    throw SettingsError("engine must be masks, disks or rays");
}

}  // namespace

struct MovingScene::Impl {
    EngineChoice choice;
    std::size_t vertices = 0;
    std::vector<MovingBody> bodies;
    std::unique_ptr<MovingEngine> engine;
    bool moved = false;  ///< since the engine was told
    std::mutex mutex;    ///< of the telling: several threads may solve at once

    /// The engine, with all bodies where they stand now.
    const MovingEngine& now(FrameReport& report)
    {
        const std::lock_guard lock(mutex);
        // a thread that waits here must not take up work that asks for the same
        if (moved)
            tbb::this_task_arena::isolate([&] { engine->move(bodies, report); });
        moved = false;
        return *engine;
    }

    void change(std::uint32_t body, MovingBody to)
    {
        require(body >= 1 && body < bodies.size(), "there is no such body");
        MovingBody& is = bodies[body];
        if (is.placement == to.placement && is.form == nullptr && to.form == nullptr)
            return;
        to.version = is.version + 1;
        is = std::move(to);
        moved = true;
    }
};

MovingScene::MovingScene(const Geometry& geometry, std::span<const std::uint32_t> body_of_triangle,
                         const EngineChoice& choice)
    : impl_(std::make_unique<Impl>())
{
    require(choice.device == Device::cpu, "moving scenes are solved on the CPU");
    require(body_of_triangle.size() == geometry.triangles.size(),
            "every triangle must belong to a body");
    std::vector<BodyMesh> bodies = split_bodies(geometry, body_of_triangle);
    impl_->choice = choice;
    impl_->vertices = geometry.positions.size();
    impl_->bodies.resize(bodies.size());
    impl_->engine = moving_engine(geometry, std::move(bodies), choice);
}
MovingScene::~MovingScene() = default;
MovingScene::MovingScene(MovingScene&&) noexcept = default;
MovingScene& MovingScene::operator=(MovingScene&&) noexcept = default;

std::uint32_t MovingScene::body_count() const
{
    return static_cast<std::uint32_t>(impl_->bodies.size());
}

const EngineChoice& MovingScene::choice() const
{
    return impl_->choice;
}

void MovingScene::place(std::uint32_t body, const Placement& placement)
{
    impl_->change(body, {placement, nullptr});
}

void MovingScene::hide(std::uint32_t body)
{
    impl_->change(body, {std::nullopt, nullptr});
}

void MovingScene::deform(std::uint32_t body, std::span<const glm::vec3> positions)
{
    require(positions.size() == impl_->vertices, "one position per vertex");
    impl_->change(body, {Placement{}, std::make_shared<const std::vector<glm::vec3>>(
                                          positions.begin(), positions.end())});
}

Solution MovingScene::solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                            const Progress& progress) const
{
    FrameReport report;
    return impl_->now(report).solve(receivers, settings, progress);
}

struct MovingReceivers::Impl {
    MovingScene::Impl* scene = nullptr;  ///< where it stays when the MovingScene is moved
    MovingSettings settings;
    std::vector<Receiver> at_rest, now;
    std::vector<std::uint32_t> body_of_receiver;
    std::vector<Occlusion> occlusion;
    std::vector<std::uint64_t> versions;   ///< of the bodies, as of the last frame
    std::unique_ptr<MovingMemory> memory;  ///< null: the engine has none
    bool solved = false;                   ///< all that was asked of the last frame
};

MovingReceivers::MovingReceivers(const MovingScene& scene, std::vector<Receiver> at_rest,
                                 std::vector<std::uint32_t> body_of_receiver,
                                 const MovingSettings& settings)
    : impl_(std::make_unique<Impl>())
{
    check_settings(scene.choice(), settings);
    require(settings.tolerance >= 0.0f, "the tolerance must be 0 or more");
    require(body_of_receiver.size() == at_rest.size(), "every receiver must belong to a body");
    for (const std::uint32_t body : body_of_receiver)
        require(body < scene.body_count(), "there is no such body");
    impl_->scene = &scene.impl();
    impl_->settings = settings;
    impl_->now = at_rest;
    impl_->at_rest = std::move(at_rest);
    impl_->body_of_receiver = std::move(body_of_receiver);
    impl_->occlusion.resize(impl_->now.size());
    impl_->versions.resize(scene.body_count(), 0);
    impl_->memory =
        scene.impl().engine->remember(impl_->at_rest, impl_->body_of_receiver, settings);
}
MovingReceivers::~MovingReceivers() = default;
MovingReceivers::MovingReceivers(MovingReceivers&&) noexcept = default;
MovingReceivers& MovingReceivers::operator=(MovingReceivers&&) noexcept = default;

void MovingReceivers::deform(std::uint32_t body, std::span<const Receiver> receivers)
{
    const auto count = static_cast<std::size_t>(std::ranges::count(impl_->body_of_receiver, body));
    require(count == receivers.size(), "one receiver for each of the body's");
    std::size_t next = 0;
    for (std::size_t i = 0; i < impl_->at_rest.size(); ++i) {
        if (impl_->body_of_receiver[i] == body)
            impl_->now[i] = impl_->at_rest[i] = receivers[next++];
    }
    impl_->solved = false;
    if (impl_->memory)
        impl_->memory->deform(body, impl_->at_rest);
}

FrameReport MovingReceivers::solve(const Progress& progress)
{
    FrameReport report;
    Impl& impl = *impl_;
    const std::vector<MovingBody>& bodies = impl.scene->bodies;
    const MovingEngine& engine = impl.scene->now(report);
    Stopwatch watch;
    const auto is_moved = [&](std::size_t body) {
        return !impl.solved || bodies[body].version != impl.versions[body];
    };
    bool any_moved = false;
    for (std::size_t body = 0; body < bodies.size(); ++body)
        any_moved |= is_moved(body);
    if (!any_moved)
        return report;
    for (std::size_t i = 0; i < impl.now.size(); ++i) {
        const std::uint32_t body = impl.body_of_receiver[i];
        const auto& placement = bodies[body].placement;
        if (is_moved(body) && placement)
            impl.now[i] = placed(impl.at_rest[i], *placement);
    }
    report.place += watch.lap();
    const double before = report.place + report.tree;
    impl.solved = false;
    if (impl.memory) {
        check_receivers(impl.now);
        impl.memory->solve(impl.occlusion, report, progress);
    } else {
        const std::vector<Occlusion> found =
            engine.solve(impl.now, impl.settings, progress).occlusion;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (!bodies[impl.body_of_receiver[i]].placement)
                continue;
            impl.occlusion[i] = found[i];
            ++report.solved;
        }
    }
    for (std::size_t body = 0; body < bodies.size(); ++body)
        impl.versions[body] = bodies[body].version;
    impl.solved = true;
    report.solve = watch.lap() - (report.place + report.tree - before);
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
