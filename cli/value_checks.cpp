#include "cli/value_checks.h"

#include "cli/did_you_mean.h"
#include "surfels/number_text.h"

#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

/// The whole text as a number.
template <class Number>
std::optional<Number> whole_text_as(const std::string& text)
{
    Number value = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && rest == end ? std::optional(value) : std::nullopt;
}

std::string refusal(const std::string& text, const std::string& wanted)
{
    return '"' + text + "\" is not " + wanted;
}

std::string list_of(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace

ValueCheck one_of(std::vector<std::string> words)
{
    const std::string set = CLI::detail::generate_set(words);
    const auto check = [words = std::move(words)](const std::string& text) {
        for (const std::string& word : words)
            if (text == word)
                return std::string();
        return '"' + text + "\" is none of " + list_of(words) + did_you_mean(text, words, "");
    };
    return {check, set};
}

ValueCheck number_from(double low, double high)
{
    const std::string range = exact(low) + " to " + exact(high);
    const auto check = [low, high, range](const std::string& text) {
        const auto value = whole_text_as<double>(text);
        return value && *value >= low && *value <= high  // nan is neither
                   ? std::string()
                   : refusal(text, "a number from " + range);
    };
    return {check, range};
}

ValueCheck whole_from(std::int64_t low, std::int64_t high)
{
    const std::string range = std::to_string(low) + " to " + std::to_string(high);
    const auto check = [low, high, range](const std::string& text) {
        const auto value = whole_text_as<std::int64_t>(text);
        const bool is_octal = text.size() > 1 && text.front() == '0';  // to who reads it next
        return value && *value >= low && *value <= high && !is_octal
                   ? std::string()
                   : refusal(text, "a whole number from " + range);
    };
    return {check, range};
}

ValueCheck number_above_zero()
{
    const auto check = [](const std::string& text) {
        const auto value = whole_text_as<double>(text);
        return value && *value > 0.0 && std::isfinite(*value) ? std::string()
                                                              : refusal(text, "a number above 0");
    };
    return {check, "above 0"};
}

}  // namespace surfelao
