/// engines.h: every engine at every setting that the table holds to account, with its bounds and
/// their reasons.
#pragma once

#include "tests/stability/judge.h"

#include <vector>

namespace surfelao::stability {

[[nodiscard]] std::vector<Engine> all_engines();

}  // namespace surfelao::stability
