#include "bake/error_search.h"

#include <algorithm>
#include <cmath>

namespace surfelao {

JudgedBaker::JudgedBaker(const Geometry& geometry, Occluders* occluders, std::uint32_t check,
                         const StageProgress& progress, std::optional<double> asked)
    : count_(check), progress_(progress), asked_(asked), occluders_(occluders)
{
    if (occluders_ == nullptr)
        occluders_ = &own_.emplace(geometry);
}

void JudgedBaker::enter(std::string_view stage) const
{
    if (progress_ && !progress_(stage, 0.0))
        throw Cancelled();
}

Progress JudgedBaker::progress_in(std::string_view stage) const
{
    return [this, stage](double done) { return !progress_ || progress_(stage, done); };
}

const Prepared& JudgedBaker::prepared_for(const EngineSettings& engine, double& surfels,
                                          double& tree)
{
    if (occluders_->has(engine))
        return occluders_->prepared_for(engine);
    enter("build");
    const Prepared& prepared = occluders_->prepared_for(engine);
    surfels += prepared.seconds().surfels;
    tree += prepared.seconds().tree;
    return prepared;
}

bool JudgedBaker::take_more_points()
{
    if (count_ >= kMostSearchPoints)
        return false;
    count_ = std::min(4 * count_, kMostSearchPoints);
    check_.reset();
    return true;
}

bool is_hopeless(std::span<const Trial> trials, double error)
{
    const StatedError& last = trials.back().error;
    if (!(last.rmse > 0.0))
        return false;
    constexpr double kNoBetter = 0.01;
    const bool is_at_floor =
        trials.size() > 1 &&
        std::abs(last.rmse / trials[trials.size() - 2].error.rmse - 1.0) < kNoBetter;
    if (!last.floor)
        return is_at_floor && last.low > error;
    const double width = last.high / last.rmse;
    return last.least_floor * width > error || (is_at_floor && *last.floor * width > error);
}

}  // namespace surfelao
