/// vertex_colors.h: what the colours of a result's vertices show, and in which numbers they stand.
///
/// Programs show vertex colours where nobody has taught them what `occlusion` is. What a file looks
/// like by itself is the user's: its own colours are never lost unasked. Where a result replaces or
/// shades them, they stand in it a second time, under a name that says so:
///
///   .ply          the vertex properties `own_red own_green own_blue`
///   .obj .off     comments behind everything else, one for each vertex, `# own R G B`, in the
///                 file's own words
///   .gltf .glb    the attribute `_OWN_COLOR`, the accessor that COLOR_0 had
///
/// A file that carries them is read as if they were its colours, and one whose colours an earlier
/// bake made as if it had none: a bake of a baked file is a bake of the original, whatever colours
/// were asked for. By what a bake's colours are known: in .ply by their place (ply_file.h), in .obj
/// and .off by the mark (maker_mark.h); written without one they count as the file's own next time.
/// Alpha is kept. Colours that are all white say nothing: `automatic` shades them.
///
/// Encoding: a colour is meant in linear light (visibility .25 reflects a quarter of the light).
/// Readers take numbers of glTF as linear (its specification) and those of .ply, .obj and .off as
/// sRGB (Blender since 3.2, three.js since r152, and whoever puts bytes on a screen as they are):
/// there .25 is written as .537, byte 137. The file's own colours are always taken so; another
/// encoding is only for what is written anew.
#pragma once

#include "surfels/occlusion.h"

#include <glm/vec3.hpp>

#include <string>

namespace surfelao {

enum class VertexColors {
    /// What shows the result and loses nothing. The file has no colours: grey. It has: kept where
    /// occlusion has a place of its own beside them (.ply, glTF), shaded where it has none (.obj
    /// .off). glTF: a textured material is not tinted, its occlusion becomes a texture (gltf_io.h).
    automatic,
    grey,    ///< the visibility
    shaded,  ///< the file's own colours times the visibility; grey where it has none
    keep,    ///< the file's own; none where it has none
    bent,    ///< the bent normal as .5 + .5 n; black where there is none
};

enum class Encoding {
    automatic,  ///< as the readers of the format take it
    linear,
    srgb,
};

/// "auto", "grey", "shaded", "keep", "bent"; "auto", "linear", "srgb".
[[nodiscard]] std::string name_of(VertexColors colors);
[[nodiscard]] std::string name_of(Encoding encoding);

/// Channels in linear light, 0 to 1. own: the file's colour, white where it has none. Not for
/// `automatic`, which a writer decides first.
[[nodiscard]] glm::vec3 color_of(VertexColors what, const Occlusion& occlusion,
                                 glm::vec3 own = glm::vec3(1.0f));

}  // namespace surfelao
