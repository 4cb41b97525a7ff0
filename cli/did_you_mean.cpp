#include "cli/did_you_mean.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

std::string in_lower_case(std::string_view text)
{
    std::string lower(text);
    for (char& letter : lower)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return lower;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b)
{
    // rows of the table of distances between beginnings: two letters ago, one ago, now
    std::vector<std::size_t> earlier, last(b.size() + 1), now(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        now[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            now[j] = std::min(
                {last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = std::min(now[j], earlier[j - 2] + 1);
        }
        earlier = std::exchange(last, now);
    }
    return last.back();
}

std::string nearest_word(std::string_view typed, std::span<const std::string> words)
{
    const std::string lower = in_lower_case(typed);
    std::string nearest;
    std::size_t least = 0;
    for (const std::string& word : words) {
        const std::size_t distance = edit_distance(lower, word);
        if (5 * distance > 2 * std::max(lower.size(), word.size()))
            continue;
        if (nearest.empty() || distance < least) {
            nearest = word;
            least = distance;
        }
    }
    return nearest;
}

std::string did_you_mean(std::string_view typed, std::span<const std::string> words,
                         const std::string& otherwise)
{
    const std::string word = nearest_word(typed, words);
    return word.empty() ? otherwise : ": did you mean " + word + '?';
}

}  // namespace surfelao
