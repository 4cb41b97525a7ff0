#include "engines/moving_engine.h"
#include "engines/moving_rebuilt.h"

namespace surfelao {

std::unique_ptr<MovingEngine> moving_disks(const MovingParts& parts, const EngineChoice& choice)
{
    return std::make_unique<MovingRebuilt>(parts, choice);
}

}  // namespace surfelao
