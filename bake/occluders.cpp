#include "bake/occluders.h"

namespace surfelao {

const Prepared& Occluders::prepared_for(const EngineChoice& choice)
{
    const auto found = prepared_.find(choice.engine);
    if (found != prepared_.end())
        return found->second;
    return prepared_.emplace(choice.engine, prepare(geometry_, choice)).first->second;
}

}  // namespace surfelao
