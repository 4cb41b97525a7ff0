/// value_checks.h: what the value of an option may be, and the sentence that refuses another.
///
/// For CLI::Option::check(). nan, inf and numbers with something behind them are refused by all.
/// Each says of itself what it takes ("{cpu,gpu}", "0 to 180"), for help, manuals and completions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class Validator;
}

namespace surfelao {

using ValueCheck = CLI::Validator;

/// One of these words; another that is near to one is asked whether it was meant.
[[nodiscard]] ValueCheck one_of(std::vector<std::string> words);

/// A number from low to high, both allowed.
[[nodiscard]] ValueCheck number_from(double low, double high);

/// A whole number from low to high, both allowed, without zeros in front.
[[nodiscard]] ValueCheck whole_from(std::int64_t low, std::int64_t high);

/// A finite number above 0.
[[nodiscard]] ValueCheck number_above_zero();

}  // namespace surfelao
