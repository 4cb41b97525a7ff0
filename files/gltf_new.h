/// gltf_new.h: a mesh of another format as glTF.
///
/// A new GLB holds the mesh as it is shaded: its own normals, or those that are made where it has
/// none, so that every viewer shows it as it was baked. Read again it is a scene from glTF, and its
/// results are written as those of any other.
///
///   vertices   those of the file, in their order, and behind them copies where corners of one
///              vertex have different normals (hard edges) or places in a map; of an object only
///              those that its triangles use
///   nodes      one for each object of the file (OBJ's o, else g; text STL's solid), named as it is
///   materials  colour, map of colour (PNG or JPEG), opacity (OBJ with its MTL)
///   colours    of vertices as COLOR_0
/// Names of groups stay in Scene::labels, so that options name the same parts as without.
///
/// Coordinates stay what they are, in float; where they lie so far out that this loses more than
/// kFarInSizes allows, the nodes carry the middle of the box as a translation. Axes are not turned.
#pragma once

#include "surfels/scene.h"
#include "surfels/surface.h"

#include <filesystem>

namespace surfelao {

/// In sizes of the box, from the origin: floats of coordinates there are four bits coarser than the
/// mesh needs.
inline constexpr double kFarInSizes = 16.0;

/// The scene that was read from `path`, as if that were a glTF file: pictures are looked for from
/// there. Notes on what is left out are added. One from glTF is given back as it is. Throws
/// InputError for a scene without triangles, and for more than a GLB holds (4 GiB). O(n log n).
[[nodiscard]] Scene as_gltf(const std::filesystem::path& path, Scene scene,
                            const NormalSettings& normals = {});

}  // namespace surfelao
