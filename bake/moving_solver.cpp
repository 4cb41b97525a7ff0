#include "bake/moving_solver.h"

namespace surfelao {
namespace {

MovingSettings moving(const EngineSettings& engine)
{
    MovingSettings settings;
    static_cast<SolveSettings&>(settings) = engine;
    return settings;
}

}  // namespace

MovingSolver::MovingSolver(const MovingWorld& world, const EngineSettings& engine)
    : world_(world),
      settings_(moving(engine)),
      scene_(world.scene_for(engine)),
      receivers_(world.receivers_for(scene_, settings_)),
      values_(world)
{
}

}  // namespace surfelao
