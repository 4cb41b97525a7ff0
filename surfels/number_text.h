/// number_text.h: numbers as text, the same in every locale.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>

namespace surfelao {

/// The shortest text that reads back as the same double (or float).
template <class Real>
void append_shortest(std::string& text, Real value)
{
    char digits[32];
    const char* end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
    text.append(digits, static_cast<std::size_t>(end - digits));
}

/// With so many decimals; for |value| < 1e9.
inline void append_fixed(std::string& text, double value, int decimals)
{
    char digits[40];
    const std::to_chars_result result =
        std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::fixed, decimals);
    text.append(digits, static_cast<std::size_t>(result.ptr - digits));
}

inline void append_integer(std::string& text, std::int64_t value)
{
    char digits[24];
    const char* end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
    text.append(digits, static_cast<std::size_t>(end - digits));
}

/// "0.0123"; never in the locale's manner.
[[nodiscard]] std::string fixed(double value, int digits);
/// The same with a sign: "+0.0012".
[[nodiscard]] std::string signed_fixed(double value, int digits);
/// The shortest text that reads back as the same number.
[[nodiscard]] std::string exact(double value);

/// With so many significant digits at most: "0.0123", "1.2e-07".
[[nodiscard]] std::string significant(double value, int digits = 4);

/// "3 triangles", "1 triangle"; an irregular noun gives both forms: "vertex|vertices".
[[nodiscard]] std::string count_text(std::uint64_t count, const std::string& noun);

}  // namespace surfelao
