/// json.h: how settings stand in reports. For the .cpp files of this folder.
#pragma once

#include "engines/engine.h"

#include <nlohmann/json.hpp>

namespace surfelao {

/// Keys in the order in which they were set.
using Json = nlohmann::ordered_json;

/// What this engine was told; settings of other engines are left out. Lengths in diagonals,
/// null = unlimited.
[[nodiscard]] Json json_of(const EngineSettings& settings);

}  // namespace surfelao
