/// compare_text.h: parts of a comparison's reports. For the .cpp files of this folder.
#pragma once

#include "bake/compare.h"

#include <optional>
#include <string>

namespace surfelao {

/// The line of column names, and the lines of one comparison.
[[nodiscard]] std::string csv_head();
[[nodiscard]] std::string csv_rows_of(const Comparison& comparison);

/// "1024 x 1024 texels", " on 3 pages" where there are several, and whose coordinates.
[[nodiscard]] std::string target_text(const Comparison& comparison);

/// "4.81"; "4.81*" where extrapolated, "-" where there is none.
[[nodiscard]] std::string text_of(const std::optional<EmbreeRatio>& ratio);

/// Degrees with two digits; "-" of maps, which hold no bent normals.
[[nodiscard]] std::string bent_text(const Comparison& comparison, double degrees);

/// Two lines without the last end: points, floor, what is left out; rays and noise of references.
[[nodiscard]] std::string errors_text(const Comparison& comparison);

/// A line per row that ran once where the others ran in every round; mostly empty.
[[nodiscard]] std::string rows_run_once(const Comparison& comparison);

}  // namespace surfelao
