/// unit.h: the unit of a 3MF, which assimp leaves out.
#pragma once

#include <filesystem>

namespace surfelao {

/// Metres that 1 is in the file: those of a millimetre where it names no unit. Throws
/// std::runtime_error for one that 3MF does not know, and where the archive cannot be read.
[[nodiscard]] float metres_of_3mf(const std::filesystem::path& file);

}  // namespace surfelao
