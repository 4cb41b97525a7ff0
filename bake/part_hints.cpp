#include "bake/part_hints.h"

#include "surfels/labels.h"
#include "surfels/number_text.h"

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace surfelao {
namespace {

/// Prefixes of Unreal and others; what names end with, Godot's behind a sign and others' wherever
/// they stand. In any case of letters.
constexpr std::string_view kHullPrefixes[] = {"ucx_",   "ubx_",       "usp_",      "ucp_",
                                              "mcdcx_", "collision_", "collider_", "col_"};
constexpr std::string_view kHullWords[] = {"col",         "colonly", "convcol",
                                           "convcolonly", "ucx",     "phys"};
constexpr std::string_view kHullEnds[] = {"collision", "collisions", "collider", "colliders",
                                          "hitbox"};
constexpr std::string_view kSeparators = "_-. $";
constexpr std::size_t kNamed = 3;
constexpr std::size_t kMostCandidates = 8;  ///< for what encloses all: each is O(triangles)

std::string lower_case_of(std::string_view text)
{
    std::string lower(text);
    for (char& sign : lower)
        sign = static_cast<char>(std::tolower(static_cast<unsigned char>(sign)));
    return lower;
}

bool is_digit(char sign)
{
    return std::isdigit(static_cast<unsigned char>(sign)) != 0;
}

bool is_separator(char sign)
{
    return kSeparators.find(sign) != kSeparators.npos;
}

/// Whether any of its triangles is baked.
bool is_baked(const Mesh& mesh, const Label& label)
{
    if (mesh.unbaked.empty())
        return true;
    return std::ranges::any_of(label.ranges, [&](const Label::Range& range) {
        const auto begin = mesh.unbaked.begin() + std::ptrdiff_t{range.first};
        const auto end = begin + std::ptrdiff_t{range.count};
        return std::find(begin, end, false) != end;
    });
}

/// Without the number of a copy: rock-col.001, rock_collision_2.
std::string_view without_copy_number(std::string_view name)
{
    std::size_t end = name.size();
    while (end > 0 && is_digit(name[end - 1]))
        --end;
    const bool has_one = end > 1 && end < name.size() && is_separator(name[end - 1]);
    return has_one ? name.substr(0, end - 1) : name;
}

/// How much of such a name's end says so; 0: nothing.
std::size_t hull_end(std::string_view lower)
{
    for (const std::string_view end : kHullEnds) {
        if (lower.ends_with(end))
            return end.size();
    }
    const std::size_t before = lower.find_last_of(kSeparators);
    const bool is_one =
        before != lower.npos && before > 0 &&
        std::ranges::find(kHullWords, lower.substr(before + 1)) != std::end(kHullWords);
    return is_one ? lower.size() - before : 0;
}

/// The pattern that means all hulls which are called like this one; empty for other names.
std::string hull_pattern(const std::string& full_name)
{
    const std::string_view name = without_copy_number(full_name);
    const std::string lower = lower_case_of(name);
    for (const std::string_view prefix : kHullPrefixes) {
        if (lower.starts_with(prefix))
            return full_name.substr(0, prefix.size()) + "*";
    }
    const std::size_t end = hull_end(lower);
    if (end == 0)
        return {};
    const std::string number =
        name.size() < full_name.size() ? full_name.substr(name.size(), 1) + "*" : "";
    return "*" + std::string(name.substr(name.size() - end)) + number;
}

/// rock_LOD1.001, LOD_1_rock: what is around the level, the level as it stands, its number.
struct Level {
    std::string_view before, words, after, digits;

    /// The same for all levels of one thing.
    [[nodiscard]] std::string base() const
    {
        return std::string(before) + '*' + lower_case_of(words.substr(0, 3)) + '*' +
               std::string(after);
    }
    /// The name of what has levels: that of the finest, which may have no number.
    [[nodiscard]] std::string thing() const
    {
        std::string_view begin = before, end = after;
        while (!begin.empty() && is_separator(begin.back()))
            begin.remove_suffix(1);
        while (begin.empty() && !end.empty() && is_separator(end.front()))
            end.remove_prefix(1);
        return std::string(begin) + std::string(end);
    }
    /// Means this level of all things.
    [[nodiscard]] std::string pattern() const
    {
        return (before.empty() && !after.empty() ? "" : "*") + std::string(words) +
               (after.empty() ? "" : std::string(after.substr(0, 1)) + "*");
    }
};
std::optional<Level> level_of(const std::string& name)
{
    const std::string_view text = name;
    const std::size_t begin = lower_case_of(name).rfind("lod");
    if (begin == std::string::npos)
        return {};
    std::size_t number = begin + 3;
    number += number < text.size() && is_separator(text[number]) ? 1 : 0;
    std::size_t end = number;
    while (end < text.size() && is_digit(text[end]))
        ++end;
    if (end == number || (end < text.size() && !is_separator(text[end])))
        return {};
    return Level{text.substr(0, begin), text.substr(begin, end - begin), text.substr(end),
                 text.substr(number, end - number)};
}

std::string options_for(const std::set<std::string>& patterns)
{
    std::string text = "--exclude";
    for (const std::string& pattern : patterns)
        text += " " + shell_word(pattern);
    return text;
}

std::string list_of(const std::set<std::string>& names)
{
    std::string text;
    std::size_t count = 0;
    for (const std::string& name : names) {
        if (++count <= kNamed)
            text += (text.empty() ? "" : ", ") + name;
    }
    return text + (count > kNamed ? " and " + std::to_string(count - kNamed) + " more" : "");
}

Box box_of_label(const Scene& scene, const Label& label)
{
    Box box;
    for (const Label::Range& range : label.ranges) {
        for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
            for (int corner = 0; corner < 3; ++corner)
                box.include(scene.positions[scene.triangles[t][corner]]);
        }
    }
    return box;
}

/// Whether the middle of each is within the other: levels are often shown side by side.
bool lie_in_each_other(const Box& a, const Box& b)
{
    const auto holds = [](const Box& box, glm::dvec3 p) {
        return glm::all(glm::lessThanEqual(box.low, p)) &&
               glm::all(glm::lessThanEqual(p, box.high));
    };
    return holds(a, 0.5 * (b.low + b.high)) && holds(b, 0.5 * (a.low + a.high));
}

/// Sides of a box that are farther out than those of the other.
int outer_sides(const Box& box, const Box& other)
{
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        count += box.low[axis] < other.low[axis] ? 1 : 0;
        count += box.high[axis] > other.high[axis] ? 1 : 0;
    }
    return count;
}

/// A dome may stand on the ground, or in a little of it.
constexpr int kLeastOuterSides = 5;
constexpr double kSunk = 0.01;  ///< of its size

/// Whether it has the other within.
bool encloses(const Box& box, const Box& other)
{
    const glm::dvec3 sunk = kSunk * (box.high - box.low);
    return outer_sides(box, other) >= kLeastOuterSides &&
           glm::all(glm::lessThanEqual(box.low - sunk, other.low)) &&
           glm::all(glm::lessThanEqual(other.high, box.high + sunk));
}

}  // namespace

std::string shell_word(const std::string& name)
{
    const bool is_plain = !name.empty() && std::ranges::all_of(name, [](char sign) {
        return std::isalnum(static_cast<unsigned char>(sign)) != 0 || sign == '_' || sign == '.' ||
               sign == '-';
    });
    return is_plain ? name : "'" + name + "'";
}

std::vector<std::string> hints_by_name(const Mesh& mesh)
{
    std::set<std::string> hulls, hull_patterns;
    struct OfThing {
        std::string thing;
        std::map<std::string, const Label*> labels;  // by digits
    };
    std::map<std::string, OfThing> levels;  // by base
    for (const Label& label : mesh.scene.labels) {
        if (label.kind == LabelKind::material || !is_baked(mesh, label))
            continue;
        if (const std::string pattern = hull_pattern(label.name); !pattern.empty()) {
            hulls.insert(label.name);
            hull_patterns.insert(pattern);
        }
        if (const auto level = level_of(label.name)) {
            OfThing& of_thing = levels[level->base()];
            of_thing.thing = level->thing();
            of_thing.labels[std::string(level->digits)] = &label;
        }
    }
    std::vector<std::string> hints;
    if (!hulls.empty())
        hints.push_back(count_text(hulls.size(), "part") +
                        (hulls.size() == 1 ? " is called like a collision hull ("
                                           : " are called like collision hulls (") +
                        list_of(hulls) + "): " + options_for(hull_patterns) +
                        (hulls.size() == 1 ? " leaves it out" : " leaves them out"));
    std::set<std::string> coarse, coarse_patterns;
    std::map<std::string_view, const Label*> by_name;
    for (const Label& label : mesh.scene.labels)
        by_name.try_emplace(label.name, &label);
    for (auto& [base, of_thing] : levels) {
        const auto unnumbered = by_name.find(of_thing.thing);
        if (unnumbered != by_name.end() && is_baked(mesh, *unnumbered->second))
            of_thing.labels.try_emplace("", unnumbered->second);
        const Label* finest_label = of_thing.labels.begin()->second;
        const Box finest = box_of_label(mesh.scene, *finest_label);
        for (const auto& [digits, label] : of_thing.labels) {
            if (label == finest_label ||
                !lie_in_each_other(finest, box_of_label(mesh.scene, *label)))
                continue;
            coarse.insert(label->name);
            coarse_patterns.insert(level_of(label->name)->pattern());
        }
    }
    if (!coarse.empty())
        hints.push_back("levels of detail lie in each other (" + list_of(coarse) +
                        "): " + options_for(coarse_patterns) + " leaves the coarse ones out");
    return hints;
}

std::string name_of_enclosing(const Mesh& mesh)
{
    const Scene& scene = mesh.scene;
    const Box whole = box_of(scene, mesh.unbaked);
    std::size_t candidates = 0;
    for (const Label& label : scene.labels) {
        if (!is_baked(mesh, label) || triangle_count(label) == scene.triangles.size())
            continue;
        const Box own = box_of_label(scene, label);
        if (6 - outer_sides(whole, own) < kLeastOuterSides)
            continue;
        if (++candidates > kMostCandidates)
            return {};
        std::vector<bool> others_only = mesh.unbaked;
        others_only.resize(scene.triangles.size(), false);
        for (const Label::Range& range : label.ranges)
            std::fill_n(others_only.begin() + std::ptrdiff_t{range.first}, range.count, true);
        const Box rest = box_of(scene, others_only);
        if (rest.low.x <= rest.high.x && encloses(own, rest))
            return label.name;
    }
    return {};
}

std::string name_of_sky(const Mesh& mesh)
{
    constexpr std::string_view kWords[] = {"sky", "skydome", "skybox", "skysphere"};
    const auto is_sky = [&](std::string_view lower) {
        while (!lower.empty()) {
            const std::size_t end = std::min(lower.find_first_of(kSeparators), lower.size());
            if (std::ranges::find(kWords, lower.substr(0, end)) != std::end(kWords))
                return true;
            lower.remove_prefix(std::min(end + 1, lower.size()));
        }
        return false;
    };
    for (const Label& label : mesh.scene.labels) {
        if (is_sky(lower_case_of(label.name)) && is_baked(mesh, label) &&
            triangle_count(label) < mesh.scene.triangles.size())
            return label.name;
    }
    return {};
}

}  // namespace surfelao
