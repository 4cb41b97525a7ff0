/// bake_command.h: the settings of a bake as its command line says them, for `merge`.
#pragma once

#include "bake/bake.h"

#include <filesystem>
#include <span>
#include <string>

namespace surfelao {

/// Of one file. arguments: PartFile::arguments. Throws InputError where no bake has these.
[[nodiscard]] BakeSettings bake_settings_of(const std::filesystem::path& input,
                                            const std::filesystem::path& output,
                                            std::span<const std::string> arguments);

}  // namespace surfelao
