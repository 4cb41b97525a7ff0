#include "surfels/labels.h"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <set>

namespace surfelao {
namespace {

constexpr std::size_t kMostNames = 3;
constexpr std::size_t kComparedSigns = 64;  ///< of a name: the table below is its square

std::string lower_case(std::string_view text)
{
    std::string lower(text.substr(0, kComparedSigns));
    for (char& sign : lower)
        sign = static_cast<char>(std::tolower(static_cast<unsigned char>(sign)));
    return lower;
}

/// Signs to put in, take out or change (Levenshtein 1965).
std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t before = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = before + (a[i] == b[j] ? 0 : 1);
            before = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string_view name_of(LabelKind kind)
{
    constexpr std::string_view kNames[] = {"node", "mesh", "object", "group", "material"};
    return kNames[static_cast<std::size_t>(kind)];
}

void LabelMaker::add(LabelKind kind, std::string_view name, std::uint32_t first,
                     std::uint32_t count)
{
    if (name.empty() || count == 0)
        return;
    const auto [known, is_new] =
        numbers_.try_emplace(std::pair(kind, std::string(name)), labels_.size());
    if (is_new)
        labels_.push_back({kind, std::string(name), {}});
    std::vector<Label::Range>& ranges = labels_[known->second].ranges;
    const std::uint32_t end = first + count;
    if (ranges.empty() || ranges.back().first + ranges.back().count < first) {
        ranges.push_back({first, count});
    } else if (ranges.back().first + ranges.back().count < end) {
        ranges.back().count = end - ranges.back().first;
    }
}

std::vector<Label> LabelMaker::finish()
{
    std::ranges::stable_sort(labels_, {},
                             [](const Label& label) { return label.ranges.front().first; });
    numbers_.clear();
    return std::move(labels_);
}

std::uint64_t triangle_count(const Label& label)
{
    std::uint64_t count = 0;
    for (const Label::Range& range : label.ranges)
        count += range.count;
    return count;
}

bool is_called(const std::string& name, const std::string& pattern)
{
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

std::vector<bool> triangles_called(const Scene& scene, std::span<const std::string> patterns,
                                   std::vector<bool>& found)
{
    std::vector<bool> called(scene.triangles.size(), false);
    for (const Label& label : scene.labels) {
        bool is_meant = false;
        for (std::size_t p = 0; p < patterns.size(); ++p) {
            if (!is_called(label.name, patterns[p]))
                continue;
            found[p] = is_meant = true;
        }
        if (!is_meant)
            continue;
        for (const Label::Range& range : label.ranges)
            std::fill_n(called.begin() + std::ptrdiff_t{range.first}, range.count, true);
    }
    return called;
}

std::vector<std::string> names_near(std::span<const Label> labels, std::string_view pattern)
{
    std::string wanted(pattern);
    std::erase(wanted, '*');
    wanted = lower_case(wanted);
    std::set<std::pair<std::size_t, std::string>> near;
    for (const Label& label : labels) {
        const std::string name = lower_case(label.name);
        const bool is_within = !wanted.empty() && (name.find(wanted) != std::string::npos ||
                                                   wanted.find(name) != std::string::npos);
        const std::size_t distance = is_within ? 0 : edit_distance(name, wanted);
        if (distance <= std::max<std::size_t>(1, wanted.size() / 3))
            near.emplace(distance, label.name);
    }
    std::vector<std::string> names;
    for (const auto& [distance, name] : near) {
        if (names.size() < kMostNames && std::ranges::find(names, name) == names.end())
            names.push_back(name);
    }
    return names;
}

}  // namespace surfelao
