/// seams.h: what a map holds at the borders of charts, so that nobody sees where it was cut.
///
/// A *seam* is an edge of the surface whose two triangles lie apart in the map. A viewer fetches
/// the one side of it from one place and the other side from another. Where the surface is smooth
/// both should show the same; at a hard edge they are different and both right, so that nothing is
/// done there. Three steps:
///
/// - fill_across(): texels beyond a border hold what lies beyond the edge on the surface. A filter
///   that reaches over the border fetches the neighbour, as it would without a cut.
/// - fill_around() of image/map.h does the rest.
/// - stitch(): moves texels at both sides as little as it takes for both to show the same.
///
/// Based on:
///   Iwanicki. Lighting Technology of The Last of Us. SIGGRAPH 2013 (least squares over seams)
#pragma once

#include "atlas/layout.h"
#include "image/map.h"
#include "surfels/edges.h"
#include "surfels/progress.h"
#include "surfels/surface.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Corner normals of a smooth seam agree to this cosine at both of its ends: 8 degrees.
inline constexpr float kSmoothSeam = 0.99026807f;

struct SeamSide {
    std::uint32_t page = 0;
    std::uint32_t triangle = 0;                  ///< of the Geometry
    std::uint32_t corners[2]{0, 1};              ///< of the triangle, at the seam's ends
    glm::dvec2 ends[2]{{0.0, 0.0}, {0.0, 0.0}};  ///< on the page
};

/// ends[0] of both sides are the same place of the surface, and ends[1].
struct Seam {
    SeamSide sides[2];
    bool is_smooth = false;
};

struct Seams {
    std::vector<Seam> list;  ///< by the welded vertices of the edge
    /// Per side of a triangle (edges.h), the one that meets it in the map too: the way through a
    /// chart.
    std::vector<Side> beside;

    static constexpr Side kNone = 0xffffffff;

    [[nodiscard]] std::uint64_t smooth_count() const;
};

/// Edges at which exactly two triangles meet, in opposite directions, both in the map, at places
/// that differ by more than whole maps, or on different pages. None of blended layouts: their pages
/// overlap. None at T-junctions, whose sides share no edge. O(n).
[[nodiscard]] Seams seams_of(const Mesh& mesh, const MapLayout& layout);

/// Gives texels without a value (known[page][i] == 0) that lie beyond a smooth seam, at most
/// `rings` texels from it, what the map shows at the same place of the unfolded surface in the
/// neighbouring chart: along the edge at the same share of it, across it at the same distance. Only
/// where that place lies in that chart and its fetch takes known texels alone. The nearest seam
/// counts, of several the first; where that is a hard one, nothing happens. Sets known of what it
/// gave. One Map and one list of flags per page. O(texels + pages * seams); 8 bytes for each texel
/// of one page meanwhile.
void fill_across(const Mesh& mesh, const MapLayout& layout, const Seams& seams, std::uint32_t rings,
                 std::span<Map> pages, std::span<std::vector<std::uint8_t>> known);

/// Of each moved texel the squared change counts so much against the squared jumps.
inline constexpr double kStitchWeight = 0.1;
/// A sample whose sides differ by so much before counts half. Where they differ by more, the
/// surface changes within a texel, as in creases and between charts of few texels: to join such
/// sides moves texels that were right. RMSE displayed, counting all alike and with this:
/// FlightHelmet .0353 and .0281, skull .0058 and .0048, stanford_bunny .0042 and .0041; jumps left
/// at smooth seams of spot .0006 and .0007, of skull .006 and .024.
inline constexpr double kStitchJump = 0.05;
/// Samples of a seam per texel of its length, on the page where it is longer.
inline constexpr double kSeamSamples = 2.0;

/// Changes the texels from which smooth seams are fetched, all of which must have a value, to the
/// minimum of
///
///     sum_s w_s (a_s - b_s)^2 + kStitchWeight sum_k (x_k - x0_k)^2
///
/// a_s and b_s: what both sides show at sample s; x_k and x0_k: texels after and before; w_s: 1 /
/// (1 + (j_s / kStitchJump)^2), j_s: the jump before. No value
/// leaves the range of those before. A constant map stays the same to the bit. Each channel for
/// itself, by conjugate gradients. Time and memory: O(samples). Equal input gives equal bytes.
/// Throws Cancelled.
void stitch(const Seams& seams, std::span<Map> pages, const Progress& progress = {});

/// By how much both sides of smooth seams differ as shown, at the samples of stitch(): channel 0.
struct SeamJump {
    double rms = 0.0;
    double most = 0.0;
};
[[nodiscard]] SeamJump seam_jump(const Seams& seams, std::span<const Map> pages);

}  // namespace surfelao
