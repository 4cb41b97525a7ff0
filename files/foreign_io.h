/// foreign_io.h: formats that assimp reads: FBX, COLLADA, 3DS, 3MF, X3D.
///
/// assimp runs in a program of its own, surfelao-import (files/import/), held to limits: what it
/// does wrong there, a crash and a loop without end as well, is a sentence here. What it makes is a
/// GLB, which our reader of glTF takes as any file of a stranger; a result can be all that a result
/// of a glTF can be.
///
/// What of a file is kept stands in files/import/glb.h and materials.h.
#pragma once

#include "files/child_process.h"
#include "surfels/progress.h"
#include "surfels/scene.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// What a file of so many bytes may cost: room for small ones, some hundred times the bytes for
/// packed ones, and no more than the machine has.
[[nodiscard]] ChildLimits import_limits(std::uint64_t file_size);

/// Where surfelao-import is: in a folder libexec beside one of the folders in which this program,
/// or the module of which this code is a part, lies (PREFIX/bin/surfelao has
/// PREFIX/libexec/surfelao-import). Nothing where there is none.
[[nodiscard]] std::optional<std::filesystem::path> import_program();

struct ImportedFile {
    std::string glb;
    std::vector<std::string> notes;  ///< as Scene::notes
};

/// Throws InputError, one sentence that begins with the path, where there is no such file or the
/// program ends otherwise than well; Cancelled as run_child().
[[nodiscard]] ImportedFile import_file(const std::filesystem::path& path,
                                       const std::filesystem::path& program,
                                       const ChildLimits& limits, const Progress& progress = {});

/// The same by import_program() within import_limits(); InputError too where there is no program.
[[nodiscard]] ImportedFile import_file(const std::filesystem::path& path,
                                       const Progress& progress = {});

/// The scene of import_file() as of a .glb at the path. A note says that it came so.
[[nodiscard]] Scene read_foreign(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace surfelao
