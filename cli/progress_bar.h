/// progress_bar.h: how far it is, on a terminal; nothing elsewhere.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace surfelao {

/// A StageProgress (bake/bake.h): draws one line on stderr when that is a terminal, with the time
/// left in the stage, and stops the work once a signal was caught. The line is gone when the bar
/// is.
class ProgressBar {
public:
    explicit ProgressBar(std::string label = {});
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// False = stop.
    bool update(std::string_view stage, double done);

private:
    using Clock = std::chrono::steady_clock;
    std::string label_;
    bool on_terminal_;
    bool drawn_ = false;
    std::string stage_;
    Clock::time_point stage_start_{};
    Clock::time_point last_draw_{};
};

}  // namespace surfelao
