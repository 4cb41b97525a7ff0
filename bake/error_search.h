/// error_search.h: the cheapest setting that is exact enough.
#pragma once

#include "bake/occluders.h"
#include "bake/stated_error.h"
#include "engines/engine.h"
#include "surfels/progress.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace surfelao {

/// Told the stage at hand ("read", "solve", ...) and how much of it is done; false stops the job.
using StageProgress = std::function<bool(std::string_view stage, double done)>;

/// A setting that was tried on the way to an error.
struct Trial {
    EngineSettings engine;
    StatedError error;
};

/// Points that an error is judged at, at most, where it is close to what was asked: the interval is
/// then a quarter as wide as with kCheckPoints.
inline constexpr std::uint32_t kMostSearchPoints = 6400;

/// In the order in which the search tries them: settings with what they take of the time of
/// masks at good, median of 21 models (`docs/figures/frontier.json`). Rays that noise alone would
/// make too wrong are passed over.
struct Step {
    Engine engine;
    float setting;  ///< quality or rays
    float cost;
};
inline constexpr Step kSteps[] = {
    {Engine::masks, -1.0f, 0.5f},   {Engine::masks, 0.0f, 0.6f},   {Engine::rays, 16.0f, 0.7f},
    {Engine::masks, 1.0f, 1.0f},    {Engine::masks, 2.0f, 1.8f},   {Engine::rays, 64.0f, 2.2f},
    {Engine::masks, 3.0f, 3.2f},    {Engine::masks, 4.0f, 6.0f},   {Engine::rays, 256.0f, 7.3f},
    {Engine::rays, 1024.0f, 23.0f}, {Engine::rays, 4096.0f, 81.0f}};

/// What bakers of any target have in common: engines, and the points by which all that they bake is
/// judged. Everything given must outlive it.
class JudgedBaker {
public:
    [[nodiscard]] const ErrorCheck& check() const { return *check_; }

    /// Takes four times as many points from now on; false where they are enough.
    [[nodiscard]] bool take_more_points();

protected:
    /// geometry: what occludes where `occluders` is null. check: points; 0: nothing is judged.
    /// asked: the error that shall be told of other bakes than the first, which may be a coarse
    /// one.
    JudgedBaker(const Geometry& geometry, Occluders* occluders, std::uint32_t check,
                const StageProgress& progress, std::optional<double> asked);

    /// Says which stage begins; the moment at which a job between two stages can be stopped.
    void enter(std::string_view stage) const;
    [[nodiscard]] Progress progress_in(std::string_view stage) const;

    /// Adds what it takes to `surfels` and `tree`, in seconds.
    const Prepared& prepared_for(const EngineSettings& engine, double& surfels, double& tree);

    [[nodiscard]] const Geometry& occluding() const { return occluders_->geometry(); }

    std::uint32_t count_;
    const StageProgress& progress_;
    std::optional<double> asked_;
    std::optional<ErrorCheck> check_;  ///< once the first bake is judged

private:
    std::optional<Occluders> own_;
    Occluders* occluders_;
};

/// Whether nothing can bring the interval below `error`: the best values would have one that is as
/// wide in proportion. That is told by the floor alone, by what more exactness brought last, or,
/// of values without a known floor, by the latter alone.
[[nodiscard]] bool is_hopeless(std::span<const Trial> trials, double error);

/// The last bake is the answer: it is met, or of masks at good where nothing can meet the error.
/// `Baker` is a JudgedBaker and has bake(EngineSettings), which gives something with an `error`, an
/// `engine`, `trials` and `is_met`, and judge() of what was baked last, at the points of then.
/// kept: what becomes of the rays' independent noise in what is displayed, 0 to 1.
template <class Baker>
auto search_error(Baker& baker, const EngineSettings& engine, double error, double kept)
{
    std::vector<Trial> trials;
    decltype(baker.bake(engine)) bake;
    for (const Step& step : kSteps) {
        EngineSettings setting = engine;
        setting.engine = step.engine;
        if (step.engine == Engine::masks)
            setting.quality = step.setting;
        else
            setting.rays = static_cast<std::uint32_t>(step.setting);
        if (step.engine == Engine::rays && kept * baker.check().noise_of_rays(setting.rays) > error)
            continue;
        bake = baker.bake(setting);
        // exact enough, it seems: to be sure takes more points, not more exactness
        while (bake.error->rmse <= error && bake.error->high > error && baker.take_more_points())
            baker.judge(bake);
        trials.push_back({setting, *bake.error});
        bake.is_met = bake.error->high <= error;
        if (bake.is_met)
            break;
        if (is_hopeless(trials, error)) {
            setting.engine = Engine::masks;
            setting.quality = kGood;
            if (bake.engine != setting) {
                bake = baker.bake(setting);
                trials.push_back({setting, *bake.error});
            }
            break;
        }
    }
    bake.trials = std::move(trials);
    return bake;
}

}  // namespace surfelao
