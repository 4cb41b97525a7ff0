#include "engines/moving_rebuilt.h"

#include "surfels/stopwatch.h"

namespace surfelao {

MovingRebuilt::MovingRebuilt(const MovingParts& parts, const EngineChoice& choice)
    : at_rest_(parts.at_rest),
      body_of_triangle_(parts.body_of_triangle.begin(), parts.body_of_triangle.end()),
      choice_(choice),
      prepared_(prepare(parts.at_rest, choice))
{
}

void MovingRebuilt::move(std::span<const MovingBody> bodies, FrameReport& report)
{
    Stopwatch watch;
    Geometry geometry = at_rest_;
    geometry.triangles.clear();
    for (std::size_t t = 0; t < at_rest_.triangles.size(); ++t) {
        const MovingBody& body = bodies[body_of_triangle_[t]];
        if (!body.placement)
            continue;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = at_rest_.triangles[t][corner];
            const glm::vec3 p = body.form ? (*body.form)[vertex] : at_rest_.positions[vertex];
            geometry.positions[vertex] = *body.placement == Placement{}
                                             ? p
                                             : placed({p, {}, 0.0f}, *body.placement).position;
        }
        geometry.triangles.push_back(at_rest_.triangles[t]);
    }
    report.place += watch.lap();
    prepared_.reset();
    prepared_.emplace(prepare(geometry, choice_));
    report.tree += watch.lap();
}

Solution MovingRebuilt::solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                              const Progress& progress) const
{
    return surfelao::solve(*prepared_, receivers, settings, progress);
}

}  // namespace surfelao
