/// moving_rebuilt.h: an engine that knows no motion, prepared anew whenever a body has moved.
///
/// Internal to engines/.
#pragma once

#include "engines/moving_engine.h"

#include <optional>

namespace surfelao {

class MovingRebuilt : public MovingEngine {
public:
    MovingRebuilt(const MovingParts& parts, const EngineChoice& choice);
    void move(std::span<const MovingBody> bodies, FrameReport& report) override;
    [[nodiscard]] Solution solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                                 const Progress& progress) const override;

private:
    Geometry at_rest_;
    std::vector<std::uint32_t> body_of_triangle_;
    EngineChoice choice_;
    std::optional<Prepared> prepared_;
};

}  // namespace surfelao
