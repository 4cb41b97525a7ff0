/// read_options.h: what the commands read, and how text is to be understood.
#pragma once

#include "files/scene_io.h"

namespace CLI {
class App;
}

namespace surfelao {

/// The formats, for the help of the commands.
inline constexpr const char* kMeshOrCloud =
    "Mesh: .obj .ply .off .stl .gltf .glb .fbx .dae .zae .3ds .3mf .x3d, or cloud: .ply .pcd .xyz "
    ".pts .txt .asc";

/// --columns, --time, --animation
void add_read_options(CLI::App& command, ReadOptions& options);

}  // namespace surfelao
