#include "surfels/number_text.h"

namespace surfelao {

std::string fixed(double value, int digits)
{
    char buffer[400];  // a double has up to 309 digits before the point
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits);
    return std::string(buffer, end.ptr);
}

std::string signed_fixed(double value, int digits)
{
    std::string text = fixed(value, digits);
    if (value >= 0.0)
        text.insert(text.begin(), '+');
    return text;
}

std::string exact(double value)
{
    char buffer[64];
    return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

}  // namespace surfelao
