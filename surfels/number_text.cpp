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

std::string significant(double value, int digits)
{
    char buffer[64];
    return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value,
                                             std::chars_format::general, digits)
                                   .ptr);
}

std::string count_text(std::uint64_t count, const std::string& noun)
{
    const std::size_t bar = noun.find('|');
    std::string text = std::to_string(count) + ' ';
    if (bar == std::string::npos)
        return text + noun + (count == 1 ? "" : "s");
    return text + (count == 1 ? noun.substr(0, bar) : noun.substr(bar + 1));
}

}  // namespace surfelao
