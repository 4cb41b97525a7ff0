/// family.h: many generated scenes, for choosing constants and for judging them.
///
/// A constant that is tuned on the meshes by which it is judged says nothing about the next mesh.
/// Here are meshes of many kinds, made from a number, all different, in two halves: constants are
/// chosen on one and judged on the other.
///
///     for (std::uint32_t i = 0; i < kFamilySize; ++i)
///         if (half_of(i) == Half::judging)
///             judge(family_scene(i));
#pragma once

#include "surfels/scene.h"

#include <cstdint>
#include <span>

namespace surfelao::scenes {

enum class Half { choosing, judging };

/// What a scene is made of; each has as many scenes in either half.
inline constexpr const char* kFamilyKinds[] = {
    "smooth",          // blobs and knotted tubes
    "rough_triangle",  // with noise as fine as the triangles
    "rough_cluster",   // with noise over some ten edges
    "open",            // scans with holes, open below
    "thin",            // plates, fins and wires
    "doubled",         // one skin close over another
    "remeshed",        // triangles of one size, jittered, diagonals at random
    "adaptive",        // triangles of very different sizes on one surface
    "cad",             // extrusions with holes, fans, long slivers
    "hard_edged",      // blocks and stairs, cut into squares
    "foliage",         // leaves round twigs
    "room",            // an interior, with furniture and sometimes a window
    "town",            // houses on a ground
    "assembly",        // many parts that touch and cross
    "mixed_scale",     // small things on a large ground
    "terrain",         // a fractal height field
};
inline constexpr std::uint32_t kFamilyKindCount = std::size(kFamilyKinds);
inline constexpr std::uint32_t kFamilySize = 20 * kFamilyKindCount;

/// index: below kFamilySize; its kind is index % kFamilyKindCount.
[[nodiscard]] const char* family_kind(std::uint32_t index);
[[nodiscard]] Half half_of(std::uint32_t index);

/// Some hundred to 40,000 triangles, turned at random. The same number gives the same scene (with
/// another compiler perhaps another one of its kind). Throws std::out_of_range for an index beyond.
[[nodiscard]] Scene family_scene(std::uint32_t index);

}  // namespace surfelao::scenes
