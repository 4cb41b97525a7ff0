/// subdivide.h: a finer mesh where values at vertices cannot hold what is to be shown.
///
/// Between vertices people see the interpolated values. So the middle of each edge is asked, and
/// where the answer bends, by more than a tolerance from the mean of the ends' values, the edge is
/// cut there, in rounds, until nothing bends or edges are kShortestEdge long. Edges of pieces may
/// bend by kPieceMargin less than those of the file. A triangle is cut by
/// the number of its cut edges into two, three or four pieces:
///
///      .              .              .
///     / \            / \            / \       what is a corner of one piece
///    / | \          /---\          /---\      is one of all pieces beside it
///   /__|__\        /__\__\        /_\ /_\ .
///
/// An edge is one of the welded surface: at a seam, or where parts touch along it, both sides are
/// cut. What is asked of its middle is what a vertex there would hold: one answer where the surface
/// is smooth; where it is not, just inside of each side, and the mean for a vertex of several.
///
/// A small thing that stands in the middle of a large triangle shows at none of its edges: probes
/// inside are asked once, and as long as the piece around one does not show its answer, it is cut.
///
/// The surface stays where it is, to roundings, and so does what occludes.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/refinement.h"
#include "surfels/surface.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace surfelao {

/// In occlusion: steps of this size between neighbouring shades can be seen, smaller ones hardly.
inline constexpr double kSubdivideTolerance = 0.02;

/// Of the tolerance. Answers move by some thousandths where they are asked again of a finer mesh:
/// were pieces cut at the very tolerance, those that bend by hardly less would be cut by a second
/// run. Without it one over the room (data/) adds 3.2 % of the triangles, with .05 and .1 less than
/// 1 % and at 6 and 11 % more triangles; over generated scenes of the choosing half
/// (tests/family.h) .7, .5 and .35 % in the mean, and the worst of them 2.1, 1.5 and 1.1 %.
inline constexpr float kPieceMargin = 0.1f;

/// In diagonals: two pixels of a picture that shows the whole scene. No half of an edge is shorter.
inline constexpr float kShortestEdge = 0.002f;
/// Edges of the diagonal are short enough after 9, and what lies beside them after a few more.
inline constexpr int kMostRounds = 15;
/// In diagonals: how far off the surface is asked where no offset is told. One that followed the
/// triangles' sizes would give other answers once they are cut.
inline constexpr float kAskedOffset = kMostOffset;

/// In the unit frame, squared: the share of a triangle that one probe stands for, and the smallest
/// triangle that has any (a hundredth of the box). What casts a shadow as wide as 3 % of the
/// diagonal is found.
inline constexpr double kProbeArea = 0.001;
inline constexpr double kProbedArea = 0.01;

/// One answer per receiver.
using Ask =
    std::function<std::vector<Occlusion>(std::span<const Receiver> receivers, const Progress&)>;

struct Subdivision {
    Refinement refinement;    ///< of Mesh::scene
    std::uint64_t asked = 0;  ///< receivers
    int rounds = 0;           ///< in which something was cut
};

/// tolerance: > 0. Triangles without area and those that the geometry leaves out are cut where
/// their neighbours are. O(edges asked log edges) time, memory in proportion to the result. Equal
/// input gives equal bytes where `ask` does. Throws InputError where there would be more than
/// kMostElements, and Cancelled.
[[nodiscard]] Subdivision subdivide(const Mesh& mesh, double tolerance, const Offset& offset,
                                    const Ask& ask, const Progress& progress = {});

}  // namespace surfelao
