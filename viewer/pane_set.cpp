#include "viewer/pane_set.h"

#include <algorithm>
#include <utility>

namespace surfelao {

void PaneSet::lay_out(const std::vector<PaneWish>& wanted)
{
    if (!std::ranges::equal(panes_, wanted, is_in_place)) {
        panes_.clear();
        level_ = 0;
        for (const PaneWish& wish : wanted)
            panes_.emplace_back(renderer_, context_, wish);
    }
    for (std::size_t i = 0; i < wanted.size(); ++i)
        if (std::exchange(panes_[i].as, wanted[i]).wipe != wanted[i].wipe)
            restart();
}

void PaneSet::restart()
{
    for (Pane& pane : panes_)
        pane.sum.clear();
}

void PaneSet::move(double now)
{
    moved_at_ = now;
    restart();
}

void PaneSet::choose_detail(double now)
{
    if (!is_moving(now))
        std::fill(times_.begin() + 1, times_.end(), std::nullopt);
    const std::size_t level = is_moving(now) ? moving_detail(times_) : 0;
    if (std::exchange(level_, level) == level)
        return;
    restart();
    for (Pane& pane : panes_)
        fit_target(pane, renderer_, detail());
}

}  // namespace surfelao
