#include "engines/engine.h"

#include "engines/options.h"
#include "gpu/answers.h"
#include "gpu/context.h"
#include "gpu/gpu_disks.h"
#include "gpu/gpu_masks.h"
#include "reference/rays.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"
#include "surfels/point_cloud.h"
#include "surfels/stopwatch.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/disks/disks.h"
#include "tree/masks/masks.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace surfelao {
namespace {

std::string name_of_quality(float quality)
{
    if (quality == kDraft)
        return "draft";
    if (quality == kGood)
        return "good";
    if (quality == kBest)
        return "best";
    return "quality " + exact(quality);
}

}  // namespace

struct Prepared::Impl {
    EngineChoice choice;
    PrepareSeconds seconds;
    std::uint64_t surfel_count = 0;
    std::optional<GlContext> own_context;  // before what lives in it
    std::shared_ptr<const MaskTree> masks;
    std::optional<Octree> disks;
    std::optional<RayScene> rays;
    std::optional<GpuMasks> gpu_masks;
    std::optional<GpuDisks> gpu_disks;

    /// Where it computes; null on the CPU.
    const GlContext* context() const { return own_context ? &*own_context : choice.context; }

    ~Impl()
    {
        if (!gpu_masks && !gpu_disks)
            return;
        try {
            context()->make_current();
        } catch (const std::runtime_error&) {
            // a driver that refuses has lost the context, and the objects with it
        }
    }
};

namespace {

/// The context of a Prepared is current while this lives; its own one is then free for any thread.
class Current {
public:
    explicit Current(const Prepared::Impl& impl)
        : own_(impl.own_context ? &*impl.own_context : nullptr)
    {
        impl.context()->make_current();
    }
    ~Current()
    {
        if (own_ != nullptr)
            own_->release();
    }
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

private:
    const GlContext* own_;
};

}  // namespace

Prepared::Prepared(std::unique_ptr<const Impl> impl) : impl_(std::move(impl))
{
}
Prepared::~Prepared() = default;
Prepared::Prepared(Prepared&&) noexcept = default;
Prepared& Prepared::operator=(Prepared&&) noexcept = default;

const EngineChoice& Prepared::choice() const
{
    return impl_->choice;
}

const PrepareSeconds& Prepared::seconds() const
{
    return impl_->seconds;
}

std::uint64_t Prepared::surfel_count() const
{
    return impl_->surfel_count;
}

namespace {

struct Disks {
    std::vector<Surfel> surfels;
    std::vector<OccluderSide> sides;
};

/// make_disks: for the disk engine alone.
Prepared prepare_with(const Geometry& geometry, const EngineChoice& choice,
                      const std::function<Disks()>& make_disks)
{
    auto impl = std::make_unique<Prepared::Impl>();
    impl->choice = choice;
    require(runs_on(choice.engine, choice.device),
            name_of(choice.engine) + " do not run on the GPU");
    const bool on_gpu = choice.device == Device::gpu;
    if (on_gpu && choice.context == nullptr)
        impl->own_context.emplace(GlContext::create());
    std::optional<Current> current;
    if (on_gpu)
        current.emplace(*impl);
    Stopwatch watch;
    switch (choice.engine) {
        case Engine::masks:
            static_cast<void>(kernel_set_of(choice.instructions));
            impl->masks = build_mask_tree(geometry);
            if (on_gpu) {
                impl->gpu_masks.emplace(*impl->context(), *impl->masks);
                impl->masks.reset();
            }
            break;
        case Engine::disks: {
            const Disks disks = make_disks();
            impl->surfel_count = disks.surfels.size();
            impl->seconds.surfels = watch.lap();
            impl->disks = build_octree(disks.surfels, disks.sides);
            if (on_gpu)
                impl->gpu_disks.emplace(*impl->context(), *impl->disks);
            break;
        }
        case Engine::rays:
            impl->rays.emplace(geometry, RayScene::Build::fast, isa_of(choice.instructions));
            break;
    }
    impl->seconds.tree = watch.lap();
    return Prepared(std::move(impl));
}

}  // namespace

Prepared prepare(const Geometry& geometry, const EngineChoice& choice)
{
    return prepare_with(geometry, choice, [&]() -> Disks {
        SurfelCloud cloud = surfels_of(geometry);
        std::vector<OccluderSide> sides = sides_of(cloud, analyse_topology(geometry));
        return {std::move(cloud.surfels), std::move(sides)};
    });
}

Prepared prepare(const PointCloud& cloud, const Geometry& squares, const EngineChoice& choice)
{
    return prepare_with(squares, choice, [&]() -> Disks {
        return {disks_of(cloud),
                std::vector<OccluderSide>(cloud.occluders.size(), OccluderSide::both)};
    });
}

namespace {

/// The context must be current.
Solution solve_on_gpu(const Prepared::Impl& impl, std::span<const Receiver> receivers,
                      const SolveSettings& settings, const Progress& progress)
{
    Solution solution;
    if (impl.gpu_masks) {
        solution.occlusion = read_answers(
            impl.gpu_masks->solve(receivers, mask_options(impl.choice, settings), progress),
            receivers.size());
    } else {
        const GpuDiskResult solved =
            impl.gpu_disks->solve(receivers, disk_options(settings), progress);
        solution.occlusion = read_answers(solved.answers, receivers.size());
        solution.residual = residual_of(solved.residuals);
    }
    return solution;
}

}  // namespace

Solution solve(const Prepared& prepared, std::span<const Receiver> receivers,
               const SolveSettings& settings, const Progress& progress,
               const ForgetReceivers& forget)
{
    const Prepared::Impl& impl = prepared.impl();
    check_settings(impl.choice, settings);
    check_receivers(receivers);
    std::optional<Current> current;
    if (impl.choice.device == Device::gpu)
        current.emplace(impl);
    Solution solution;
    Stopwatch watch;
    if (current) {
        solution = solve_on_gpu(impl, receivers, settings, progress);
    } else if (impl.masks) {
        solution.occlusion = solve_masks(*impl.masks, receivers,
                                         mask_options(impl.choice, settings), progress, forget);
    } else if (impl.disks) {
        DiskResult solved = solve_disks(*impl.disks, receivers, disk_options(settings), progress);
        solution.occlusion = std::move(solved.occlusion);
        solution.residual = residual_of(solved.residuals);
    } else {
        solution.occlusion =
            trace_occlusion(*impl.rays, receivers, ray_options(settings), progress);
    }
    solution.seconds = watch.lap();
    return solution;
}

std::vector<Solution> solve_lists(const Prepared& prepared,
                                  std::span<const std::span<const Receiver>> lists,
                                  const SolveSettings& settings, const Progress& progress)
{
    const Prepared::Impl& impl = prepared.impl();
    check_settings(impl.choice, settings);
    for (const std::span<const Receiver> receivers : lists)
        check_receivers(receivers);
    Stopwatch watch;
    std::vector<Solution> solutions;
    if (impl.disks && impl.choice.device == Device::cpu && !lists.empty()) {
        for (DiskResult& solved :
             solve_disk_lists(*impl.disks, lists, disk_options(settings), progress))
            solutions.push_back({std::move(solved.occlusion), 0.0, residual_of(solved.residuals)});
    } else {
        double count = 0.0, done = 0.0;  // receivers
        for (const std::span<const Receiver> receivers : lists)
            count += static_cast<double>(receivers.size());
        for (const std::span<const Receiver> receivers : lists) {
            const double size = static_cast<double>(receivers.size());
            const auto part = [&, done](double share) {
                return progress((done + size * share) / std::max(1.0, count));
            };
            solutions.push_back(
                solve(prepared, receivers, settings, progress ? Progress(part) : Progress()));
            solutions.back().seconds = 0.0;
            done += size;
        }
    }
    if (!solutions.empty())
        solutions.front().seconds = watch.lap();
    return solutions;
}

void check_settings(const EngineChoice& choice, const SolveSettings& settings)
{
    check_definition(settings.definition);
    require(knows_kernel(choice.engine, settings.definition.kernel),
            name_of(choice.engine) + " know the cosine kernel only");
    require(settings.share.index < settings.share.count, "the share must be one of all");
    require(settings.share.count == 1 || choice.device == Device::cpu,
            "shares of receivers are solved on the CPU only");
    if (choice.engine == Engine::rays) {
        require(settings.rays >= 1 && settings.rays <= kMostRays,
                "rays must be between 1 and " + std::to_string(kMostRays));
        return;
    }
    require(settings.quality >= least_quality(choice.engine) &&
                settings.quality <= most_quality(choice.engine),
            "quality of " + name_of(choice.engine) + " must be between " +
                exact(least_quality(choice.engine)) + " and " + exact(most_quality(choice.engine)));
    if (choice.engine == Engine::disks) {
        require(settings.passes >= 1, "passes must be at least 1");
        require(settings.strength >= 0.0f && std::isfinite(settings.strength),
                "strength must be 0 or more, and finite");
    }
}

std::string name_of(Engine engine)
{
    switch (engine) {
        case Engine::masks:
            return "masks";
        case Engine::disks:
            return "disks";
        case Engine::rays:
            return "rays";
    }
    throw SettingsError("engine must be masks, disks or rays");
}

float least_quality(Engine engine)
{
    return engine == Engine::masks ? MaskOptions::kCoarsest : kDraft;
}

float most_quality(Engine engine)
{
    switch (engine) {
        case Engine::masks:
            return MaskOptions::kFinest;
        case Engine::disks:
            return kBest;
        case Engine::rays:
            return 0.0f;
    }
    throw SettingsError("engine must be masks, disks or rays");
}

bool knows_kernel(Engine engine, Kernel kernel)
{
    return kernel == Kernel::cosine || engine != Engine::masks;
}

bool runs_on(Engine engine, Device device)
{
    return device == Device::cpu || engine != Engine::rays;
}

std::string setting_of(const EngineSettings& settings)
{
    if (settings.engine != Engine::rays)
        return name_of_quality(settings.quality) +
               (settings.device == Device::gpu ? " on GPU" : "");
    return std::to_string(settings.rays) + (settings.rays == 1 ? " ray" : " rays");
}

Definition definition_of(const DistanceLimit& limit, Kernel kernel, const Frame& frame)
{
    require(limit.value > 0.0, "max_distance must be above 0");
    require(limit.falloff == Falloff::none || std::isfinite(limit.value),
            "a falloff needs a max_distance");
    const double share = limit.percent ? limit.value / 100.0 : limit.value / frame.diagonal;
    Definition definition;
    definition.kernel = kernel;
    definition.max_distance = static_cast<float>(share);
    if (!std::isfinite(definition.max_distance))
        return definition;  // no limit, or one that nothing in the scene can reach
    if (!(definition.max_distance > 0.0f))
        throw InputError("the distance limit vanishes beside the scene's size of " +
                         std::to_string(frame.diagonal));
    definition.falloff = limit.falloff;
    return definition;
}

std::optional<Ground> ground_of(
    const std::optional<GroundPlane>& plane,
    std::initializer_list<std::reference_wrapper<const Geometry>> geometries, float offset)
{
    if (!plane)
        return std::nullopt;
    double lowest = std::numeric_limits<double>::max();
    for (const Geometry& geometry : geometries)
        for (const glm::uvec3 triangle : geometry.triangles)
            for (int corner = 0; corner < 3; ++corner)
                lowest = std::min(
                    lowest, double{glm::dot(plane->up, geometry.positions[triangle[corner]])});
    if (lowest == std::numeric_limits<double>::max())
        lowest = 0.0;  // nothing stands on it
    const Frame& frame = geometries.begin()->get().frame;
    const double gap = 2.0 * offset;
    double height = lowest - gap;
    if (plane->height) {
        const double asked =
            (*plane->height - glm::dot(glm::dvec3(plane->up), frame.centre)) / frame.diagonal;
        if (std::abs(asked - lowest) > gap)
            height = asked;
    }
    if (!(std::abs(height) <= kFarthestReceiver))
        throw InputError("the ground at " + exact(*plane->height) +
                         " is farther than a million diagonals from the scene");
    return Ground{plane->up, static_cast<float>(height)};
}

GroundPlane plane_of(const Ground& ground, const Frame& frame)
{
    const double centre = glm::dot(glm::dvec3(ground.up), frame.centre);
    return {ground.up, centre + ground.height * frame.diagonal};
}

namespace {

std::string axis_of(const GroundPlane& plane)
{
    const glm::vec3 up = plane.up;
    if (up == glm::vec3(0, 1, 0))
        return "y";
    if (up == glm::vec3(0, 0, 1))
        return "z";
    return exact(up.x) + ":" + exact(up.y) + ":" + exact(up.z);
}

}  // namespace

std::string text_of(const GroundPlane& plane)
{
    return axis_of(plane) + ":" + (plane.height ? exact(*plane.height) : "lowest");
}

std::string text_of(const Ground& ground, const Frame& frame)
{
    const GroundPlane plane = plane_of(ground, frame);
    std::string text = axis_of(plane) + " = ";
    constexpr int kDigits = 6;  // what a float of the unit frame is right to, and no rounding
    char digits[32];
    return text.append(digits, std::to_chars(std::begin(digits), std::end(digits), *plane.height,
                                             std::chars_format::general, kDigits)
                                   .ptr);
}

}  // namespace surfelao
