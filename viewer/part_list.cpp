#include "viewer/part_list.h"

#include "surfels/labels.h"

#include <algorithm>
#include <string_view>

namespace surfelao {
namespace {

/// A pattern that means this name alone.
std::string pattern_of(std::string_view name)
{
    std::string pattern;
    for (const char sign : name) {
        if (std::string_view("*?[]\\").find(sign) != std::string_view::npos)
            pattern += '\\';
        pattern += sign;
    }
    return pattern;
}

bool is_called_by(const std::string& name, const std::vector<std::string>& patterns)
{
    return std::ranges::any_of(
        patterns, [&](const std::string& pattern) { return is_called(name, pattern); });
}

/// Of one kind, without those that have another one within: groups of nodes. Labels come in the
/// order of their triangles, so a group stands before what lies in it.
std::vector<const Label*> innermost(const Scene& scene, LabelKind kind)
{
    std::vector<const Label*> found;
    for (const Label& label : scene.labels) {
        if (label.kind != kind)
            continue;
        while (!found.empty()) {
            const Label::Range& last = found.back()->ranges.back();
            if (label.ranges.front().first >= last.first + last.count)
                break;
            found.pop_back();
        }
        found.push_back(&label);
    }
    return found;
}

}  // namespace

std::vector<const Label*> parting_labels(const Scene& scene)
{
    std::vector<const Label*> labels;
    for (const LabelKind kind : {LabelKind::node, LabelKind::object, LabelKind::group,
                                 LabelKind::mesh, LabelKind::material}) {
        std::vector<const Label*> of_kind = innermost(scene, kind);
        if (of_kind.size() > labels.size())
            labels = std::move(of_kind);
    }
    return labels;
}

std::vector<PartTick> part_ticks(const Scene& scene, const PartChoice& choice)
{
    std::vector<PartTick> ticks;
    for (const Label* label : parting_labels(scene)) {
        PartTick& tick = ticks.emplace_back();
        tick.name = label->name;
        tick.triangles = triangle_count(*label);
        tick.occludes = !is_called_by(label->name, choice.exclude);
        tick.is_baked =
            choice.receivers.empty() ? tick.occludes : is_called_by(label->name, choice.receivers);
    }
    return ticks;
}

PartChoice choice_of(const std::vector<PartTick>& ticks, PartChoice choice)
{
    choice.exclude.clear();
    choice.receivers.clear();
    const bool is_simple = std::ranges::all_of(
        ticks, [](const PartTick& tick) { return tick.occludes == tick.is_baked; });
    for (const PartTick& tick : ticks) {
        if (!tick.occludes)
            choice.exclude.push_back(pattern_of(tick.name));
        if (tick.is_baked && !is_simple)
            choice.receivers.push_back(pattern_of(tick.name));
    }
    return choice;
}

}  // namespace surfelao
