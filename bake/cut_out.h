/// cut_out.h: what is left of surfaces whose texture's alpha cuts holes into them (glTF's alphaMode
/// MASK, OBJ's map_d): leaves on a card, a fence on a quad.
///
/// Who occludes must be triangles, for every engine alike. A triangle of such a material that the
/// alpha leaves whole stays, one that it takes away wholly goes. Any other is cut in two across its
/// longest edge, and its halves again, the largest piece of all first, until pieces are wholly
/// there or wholly gone, show one texel, or together make up less than kUndecided of all such
/// surface; then the alpha at a piece's centre decides.
#pragma once

#include "surfels/base_colors.h"
#include "surfels/scene.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace surfelao {

/// Of the surface whose alpha is looked at, the area of pieces that the alpha at their centre
/// decides. What is wrongly there and wrongly gone is a part of it, and mostly evens out.
inline constexpr double kUndecided = 0.02;

/// More pieces are not made, whatever is undecided: their tree takes half a second then. A pine
/// whose 1,442 cards have needles a few texels wide is .020 RMS of the occlusion at its vertices
/// from the one of seven times as many pieces; with a third as many pieces .041, with three times
/// .016.
inline constexpr std::size_t kMostPieces = std::size_t{1} << 18;

struct CutOut {
    /// In a scene triangle, with weights of its second and third corner at the piece's corners.
    struct Piece {
        std::uint32_t triangle = 0;
        glm::dvec2 corners[3]{};
    };
    std::vector<bool> replaced;  ///< scene triangles in whose place the pieces stand; empty: none
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> triangles;  ///< those that are replaced
    double share = 0.0;                    ///< of the area of surface with alpha that is gone
    bool is_coarse = false;                ///< kMostPieces stopped it
    std::vector<std::string> notes;        ///< what could not be honoured
};

/// wanted: scene triangles that are looked at; empty: all. Pictures that cannot be read and
/// texture coordinates that are not there leave their triangles whole, with a note. Vertex colours
/// do not count. O(pieces log pieces + pixels).
[[nodiscard]] CutOut cut_out(const Scene& scene, const BaseColors& colors,
                             const std::vector<bool>& wanted);

}  // namespace surfelao
