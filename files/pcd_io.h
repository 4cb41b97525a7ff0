/// pcd_io.h: clouds of the Point Cloud Library, .PCD v.7 and the versions before it that have the
/// same lines: ascii, binary and binary_compressed.
///
/// Read: fields x, y, z of any type but integers of 8 bytes; normal_x, normal_y, normal_z (or nx ny
/// nz) if all three are there; `rgb` or `rgba`, a number of 4 bytes that packs a colour, in ascii
/// as a float or as a whole number. VIEWPOINT gives Scene::viewpoint unless it is the origin, which
/// programs write that know none. Other fields are kept. Without HEIGHT it is 1, without COUNT all
/// are 1, without POINTS they are WIDTH x HEIGHT. Bytes behind binary data are ignored. Points
/// without a finite place are what an organised cloud has where nothing was seen: they are kept
/// (Scene::placeless).
#pragma once

#include "files/scene_io.h"

#include <span>
#include <string>

namespace surfelao {

/// file_name is what faults are reported of; contents is the file. Faults name the line in the
/// header and in ascii data.
[[nodiscard]] Scene read_pcd(const std::string& file_name, std::string contents);

/// The cloud as PCD with the fields `occlusion`, `bent_nx bent_ny bent_nz` and, as one number, the
/// colour `rgb` (vertex_colors.h) behind the others; `automatic` keeps the colours of the file, all
/// of them white: shades. Colours that others are shown in place of stand last, as `own_rgb`.
///
/// A cloud that came from PCD gives its own file with nothing else changed; compressed data become
/// `binary`. Any other gives a new binary file of its coordinates, normals, colours and other
/// columns. Coordinates are float, or double as in ply_io.h.
/// options.mark: a comment in front of the line FIELDS, in the place of an older one.
[[nodiscard]] WrittenFile pcd_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                                       const WriteOptions& options = {});

}  // namespace surfelao
