/// cases.h: the hard cases by group; all_cases() of world.h is their sum.
#pragma once

#include "tests/stability/world.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace surfelao::stability {

/// Flat things with closed forms: sheets close together, coincident, creased, cut into slivers.
void add_sheet_cases(std::vector<Case>& cases);

/// Bodies and hollows: convex, closed, nested, interpenetrating, with openings.
void add_solid_cases(std::vector<Case>& cases);

/// What must not matter: scale, place, rotation, order, duplicates, subdivision.
void add_invariance_cases(std::vector<Case>& cases);

/// What is left of a mesh when its points or faces coincide.
void add_degenerate_cases(std::vector<Case>& cases);

/// Many parts: foliage, combs, spirals, soup, sizes far apart; limits of distance.
void add_clutter_cases(std::vector<Case>& cases);

/// A name with one number in it (printf's %g).
[[nodiscard]] std::string label(const char* format, double value);

/// Every triangle once more the other way round, over the same vertices.
[[nodiscard]] Scene two_faced(Scene scene);

inline constexpr glm::dvec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

// why the disk engine may fail, by design section 5
inline constexpr const char* kLayers = "layers";
inline constexpr const char* kOpenMesh = "open mesh";
inline constexpr const char* kThinParts = "thin parts";
inline constexpr const char* kRoom = "room";
/// A disk per vertex knows nothing of the inside of a triangle that is large for its distance.
inline constexpr const char* kCoarse = "coarse";

}  // namespace surfelao::stability
