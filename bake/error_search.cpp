#include "bake/error_search.h"

#include <cmath>

namespace surfelao {

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
