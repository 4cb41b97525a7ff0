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

/// Prefixes of Unreal, suffixes of Godot and others; in any case of letters.
constexpr std::string_view kHullPrefixes[] = {"ucx_", "ubx_", "usp_", "ucp_"};
constexpr std::string_view kHullSuffixes[] = {"_collision", "_collider",    "_col",    "-col",
                                              "-colonly",   "-convcolonly", "-convcol"};
constexpr std::size_t kNamed = 3;
constexpr std::size_t kMostCandidates = 8;  ///< for what encloses all: each is O(triangles)

std::string lower_case_of(std::string_view text)
{
    std::string lower(text);
    for (char& sign : lower)
        sign = static_cast<char>(std::tolower(static_cast<unsigned char>(sign)));
    return lower;
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

/// The pattern that means all hulls which are called like this one; empty for other names.
std::string hull_pattern(const std::string& name)
{
    const std::string lower = lower_case_of(name);
    for (const std::string_view prefix : kHullPrefixes) {
        if (lower.starts_with(prefix))
            return name.substr(0, prefix.size()) + "*";
    }
    for (const std::string_view suffix : kHullSuffixes) {
        if (lower.ends_with(suffix))
            return "*" + name.substr(name.size() - suffix.size());
    }
    return {};
}

/// rock_LOD1: "rock_LOD" and 1.
struct Level {
    std::string_view base;
    std::string_view digits;
};
std::optional<Level> level_of(const std::string& name)
{
    std::size_t end = name.size();
    while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])) != 0)
        --end;
    const std::string_view base = std::string_view(name).substr(0, end);
    const std::string lower = lower_case_of(base);
    if (end == name.size() || !(lower.ends_with("lod") || lower.ends_with("lod_")))
        return {};
    return Level{base, std::string_view(name).substr(end)};
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

/// Sides of the outer box that the inner one does not touch; 0 where it reaches out.
int free_sides(const Box& outer, const Box& inner)
{
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (inner.low[axis] < outer.low[axis] || inner.high[axis] > outer.high[axis])
            return 0;
        count += inner.low[axis] > outer.low[axis] ? 1 : 0;
        count += inner.high[axis] < outer.high[axis] ? 1 : 0;
    }
    return count;
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
    std::map<std::string, std::map<std::string, const Label*>> levels;  // by base and digits
    for (const Label& label : mesh.scene.labels) {
        if (label.kind == LabelKind::material || !is_baked(mesh, label))
            continue;
        if (const std::string pattern = hull_pattern(label.name); !pattern.empty()) {
            hulls.insert(label.name);
            hull_patterns.insert(pattern);
        }
        if (const auto level = level_of(label.name))
            levels[std::string(level->base)][std::string(level->digits)] = &label;
    }
    std::vector<std::string> hints;
    if (!hulls.empty())
        hints.push_back(count_text(hulls.size(), "part") +
                        (hulls.size() == 1 ? " is called like a collision hull ("
                                           : " are called like collision hulls (") +
                        list_of(hulls) + "): " + options_for(hull_patterns) +
                        (hulls.size() == 1 ? " leaves it out" : " leaves them out"));
    std::set<std::string> coarse, coarse_patterns;
    for (const auto& [base, of_base] : levels) {
        const Box finest = box_of_label(mesh.scene, *of_base.begin()->second);
        for (const auto& [digits, label] : of_base) {
            if (label == of_base.begin()->second ||
                !lie_in_each_other(finest, box_of_label(mesh.scene, *label)))
                continue;
            coarse.insert(label->name);
            coarse_patterns.insert("*" + label->name.substr(lower_case_of(base).rfind("lod")));
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
        constexpr int kLeastSides = 5;  // a dome may stand on the ground
        if (glm::min(own.low, whole.low) != own.low || glm::max(own.high, whole.high) != own.high)
            continue;
        if (++candidates > kMostCandidates)
            return {};
        std::vector<bool> others_only = mesh.unbaked;
        others_only.resize(scene.triangles.size(), false);
        for (const Label::Range& range : label.ranges)
            std::fill_n(others_only.begin() + std::ptrdiff_t{range.first}, range.count, true);
        const Box rest = box_of(scene, others_only);
        if (rest.low.x <= rest.high.x && free_sides(own, rest) >= kLeastSides)
            return label.name;
    }
    return {};
}

}  // namespace surfelao
