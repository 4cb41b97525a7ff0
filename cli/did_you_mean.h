/// did_you_mean.h: the known word that a mistyped one was meant to be.
///
/// Based on:
///   Damerau. A technique for computer detection and correction of spelling errors. 1964
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace surfelao {

/// Letters to insert, to drop, to change, and neighbours to swap, until `a` is `b`; what was
/// swapped is not changed again (optimal string alignment). O(a * b).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word nearest to `typed`, whatever the case of its letters; the first of several. Empty where
/// more than two letters in five would have to change: that is what it takes from "vertex" to
/// "vertices", and words that differ in half of their letters are others.
[[nodiscard]] std::string nearest_word(std::string_view typed, std::span<const std::string> words);

/// ": did you mean WORD?" by nearest_word(); without one `otherwise`.
[[nodiscard]] std::string did_you_mean(std::string_view typed, std::span<const std::string> words,
                                       const std::string& otherwise);

}  // namespace surfelao
