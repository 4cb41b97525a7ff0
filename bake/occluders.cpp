#include "bake/occluders.h"

namespace surfelao {

const Prepared& Occluders::prepared_for(const EngineChoice& choice)
{
    if (is_ready(choice))
        return *ready_;
    const auto found = prepared_.find(choice.engine);
    if (found != prepared_.end())
        return found->second;
    return prepared_
        .emplace(choice.engine, cloud_ != nullptr ? prepare(*cloud_, geometry_, choice)
                                                  : prepare(geometry_, choice))
        .first->second;
}

}  // namespace surfelao
