/// pane_set.h: the pictures of a window, sample by sample, and how finely they are drawn while
/// something moves.
#pragma once

#include "viewer/coarse.h"
#include "viewer/pane.h"
#include "viewer/pane_layout.h"

#include <cstddef>
#include <span>
#include <vector>

namespace surfelao {

/// Of one context and renderer, which must outlive it.
class PaneSet {
public:
    PaneSet(const GlContext& context, const Renderer& renderer)
        : context_(context), renderer_(renderer)
    {
    }

    /// Pictures where they are wanted; they begin anew where anything has changed.
    void lay_out(const std::vector<PaneWish>& wanted);
    std::span<Pane> all() { return panes_; }
    std::span<const Pane> all() const { return panes_; }
    bool empty() const { return panes_.empty(); }

    /// What they show begins anew.
    void restart();
    int samples() const { return panes_.empty() ? 0 : panes_.front().sum.count(); }

    /// now: glfwGetTime(). What is shown is elsewhere.
    void move(double now);
    bool is_moving(double now) const { return now - moved_at_ < kRestSeconds; }
    void rest() { moved_at_ = -kRestSeconds; }  ///< what is drawn next is whole, at once

    /// Once a frame: as fine as there is time for.
    void choose_detail(double now);
    const Detail& detail() const { return kDetails[level_]; }
    bool is_coarse() const { return level_ != 0; }
    PictureSize drawn_size() const { return surfelao::drawn_size(panes_.front(), detail()); }

    /// What drawing all of them once took.
    void tell_time(double ms) { times_[level_] = ms; }
    void forget_times() { times_ = {}; }  ///< of another file

private:
    const GlContext& context_;
    const Renderer& renderer_;
    std::vector<Pane> panes_;
    std::size_t level_ = 0;  ///< of kDetails, that is drawn
    DetailTimes times_;
    double moved_at_ = -kRestSeconds;
};

}  // namespace surfelao
