#include "cli/progress_bar.h"

#include "cli/interrupt.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace surfelao {
namespace {

constexpr int kWidth = 24;
constexpr double kSecondsBetweenDraws = 0.1;
constexpr double kShareToTrust = 0.02;  // of the stage, before a time left means anything

std::string time_text(double seconds)
{
    const int whole = static_cast<int>(std::min(seconds + 0.5, 1e8));
    if (whole < 60)
        return std::to_string(whole) + " s";
    if (whole < 3600)
        return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
    return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

}  // namespace

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), on_terminal_(isatty(STDERR_FILENO) == 1)
{
}

ProgressBar::~ProgressBar()
{
    if (drawn_)
        std::fputs("\r\033[K", stderr);
}

bool ProgressBar::update(std::string_view stage, double done)
{
    if (caught_signal() != 0)
        return false;
    if (!on_terminal_)
        return true;

    const Clock::time_point now = Clock::now();
    const bool new_stage = stage != stage_;
    if (new_stage) {
        stage_ = stage;
        stage_start_ = now;
    }
    const std::chrono::duration<double> since_draw = now - last_draw_;
    if (!new_stage && since_draw.count() < kSecondsBetweenDraws)
        return true;
    last_draw_ = now;
    drawn_ = true;

    const int filled = static_cast<int>(done * kWidth);
    const std::chrono::duration<double> passed = now - stage_start_;
    std::string line = "\r\033[K" + label_ + '[' +
                       std::string(static_cast<std::size_t>(filled), '#') +
                       std::string(static_cast<std::size_t>(kWidth - filled), '.') + "] " +
                       std::to_string(static_cast<int>(done * 100.0)) + " % " + stage_;
    if (done > kShareToTrust)
        line += ", " + time_text(passed.count() * (1.0 - done) / done) + " left";
    std::fputs(line.c_str(), stderr);
    return true;
}

}  // namespace surfelao
