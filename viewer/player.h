/// player.h: the clock of an animation: played, held, scrubbed.
#pragma once

#include <algorithm>
#include <cmath>

namespace surfelao {

struct Player {
    double first = 0.0, last = 0.0;  ///< seconds of the animation; first <= last
    double seconds = 0.0;            ///< where it stands, between them
    double speed = 1.0;              ///< seconds of the animation a second; > 0
    bool loops = true;               ///< else it stops at the end
    bool is_playing = false;

    void seek(double to) { seconds = std::clamp(to, first, last); }

    /// From the beginning, where it stands at the end.
    void toggle()
    {
        is_playing = !is_playing && last > first;
        if (is_playing && seconds >= last)
            seconds = first;
    }

    /// elapsed: seconds on the wall, >= 0.
    void advance(double elapsed)
    {
        if (!is_playing)
            return;
        const double to = seconds + speed * elapsed;
        if (to <= last) {
            seconds = to;
        } else if (loops && last > first) {
            seconds = first + std::fmod(to - first, last - first);
        } else {
            seconds = last;
            is_playing = false;
        }
    }
};

}  // namespace surfelao
