#include "bake/roles.h"

#include "surfels/errors.h"
#include "surfels/labels.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace surfelao {
namespace {

using Scenes = std::span<const Scene>;

/// Throws for the first pattern that means nothing in any of the scenes.
void check_found(const std::vector<std::string>& patterns, const std::vector<bool>& found,
                 std::initializer_list<Scenes> scenes, const char* option)
{
    const auto missing = std::ranges::find(found, false);
    if (missing == found.end())
        return;
    const std::string& pattern = patterns[static_cast<std::size_t>(missing - found.begin())];
    std::string files, near;
    std::vector<Label> labels;
    for (const Scenes list : scenes) {
        for (const Scene& scene : list) {
            files += (files.empty() ? "" : ", ") + scene.name;
            labels.insert(labels.end(), scene.labels.begin(), scene.labels.end());
        }
    }
    const std::string fault = files + ": " + option + " " + pattern + " means no part of it";
    if (labels.empty())
        throw InputError(fault + ": nothing there has a name");
    for (const std::string& name : names_near(labels, pattern))
        near += (near.empty() ? "" : ", ") + name;
    throw InputError(fault + (near.empty() ? "" : " (near it: " + near + ")") +
                     "; surfelao info lists all names");
}

/// "material Glass", "materials Glass, Water and 3 more"
std::string materials_text(const BaseColors& colors, const std::vector<bool>& which)
{
    constexpr std::size_t kNamed = 3;
    std::string names;
    std::size_t count = 0;
    for (std::size_t m = 0; m < which.size(); ++m) {
        if (!which[m] || ++count > kNamed)
            continue;
        const std::string& name = colors.materials[m].name;
        names += (names.empty() ? "" : ", ") + (name.empty() ? "without a name" : name);
    }
    if (count > kNamed)
        names += " and " + std::to_string(count - kNamed) + " more";
    return (count == 1 ? "material " : "materials ") + names;
}

std::string cut_text(const CutOut& cut, const std::string& materials)
{
    const std::string pieces = count_text(cut.pieces.size(), "piece");
    return "holes by the alpha of " + materials + " occlude nothing: " + pieces +
           (cut.pieces.size() == 1 ? " occludes" : " occlude") + " in place of " +
           count_text(cut.triangles.size(), "triangle") +
           (cut.is_coarse ? ", the most there may be: coarser than the picture" : "");
}

}  // namespace

std::vector<Roles> roles_of(Scenes inputs, Scenes others, const PartChoice& choice)
{
    std::vector<bool> excluded(choice.exclude.size(), false);
    std::vector<bool> received(choice.receivers.size(), false);
    std::vector<Roles> roles;
    const auto look_at = [&](const Scene& scene, bool is_input) {
        Roles& own = roles.emplace_back();
        if (!choice.exclude.empty()) {
            own.occlude = triangles_called(scene, choice.exclude, excluded);
            own.occlude.flip();
        }
        if (!is_input)
            return;
        own.baked = own.occlude;
        if (!choice.receivers.empty())
            own.baked = triangles_called(scene, choice.receivers, received);
        if (choice.alone)
            own.occlude = own.baked;
    };
    for (const Scene& scene : inputs)
        look_at(scene, true);
    for (const Scene& scene : others)
        look_at(scene, false);
    check_found(choice.exclude, excluded, {inputs, others}, "--exclude");
    check_found(choice.receivers, received, {inputs}, "--receivers");
    return roles;
}

void open_materials(const Scene& scene, ClearSurfaces clear, Roles& roles,
                    std::vector<std::string>& notes)
{
    if (!scene.asset || !scene.asset->has_openings())
        return;
    BaseColors colors = scene.asset->base_colors();
    for (BaseColor& material : colors.materials) {
        if (material.opacity == Opacity::clear && clear == ClearSurfaces::cut)
            material.opacity = Opacity::cut;
    }
    if (colors.triangles.size() != scene.triangles.size())
        return;
    std::vector<bool> clears(colors.materials.size(), false), cuts(colors.materials.size(), false);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const std::uint32_t material = colors.triangles[t];
        const Opacity opacity = colors.materials[material].opacity;
        if (opacity == Opacity::solid || !roles.occludes(t))
            continue;
        (opacity == Opacity::cut ? cuts : clears)[material] = true;
        if (opacity == Opacity::cut || clear == ClearSurfaces::solid)
            continue;
        if (roles.baked.empty())
            roles.baked = std::vector<bool>(scene.triangles.size(), true);
        if (roles.occlude.empty())
            roles.occlude = std::vector<bool>(scene.triangles.size(), true);
        roles.occlude[t] = false;
    }
    if (std::ranges::find(clears, true) != clears.end())
        notes.push_back(materials_text(colors, clears) +
                        (clear == ClearSurfaces::open
                             ? ", which light goes through, occludes nothing"
                             : ", which light goes through, occludes as if it were solid "
                               "(--transparent open: not at all; cut: where its alpha is at "
                               "least half)"));
    if (std::ranges::find(cuts, true) == cuts.end())
        return;
    roles.cut = cut_out(scene, colors, roles.occlude);
    if (!roles.cut.triangles.empty())
        notes.push_back(cut_text(roles.cut, materials_text(colors, cuts)));
    notes.insert(notes.end(), roles.cut.notes.begin(), roles.cut.notes.end());
}

void check_baked(const Scene& scene, const Roles& own, std::size_t inputs)
{
    if (own.baked.empty() || std::ranges::find(own.baked, true) != own.baked.end())
        return;
    throw InputError(scene.name + ": nothing of it is left to be baked" +
                     (inputs > 1 ? ", --occluders is for what only occludes" : ""));
}

void check_occluder(const Scene& scene)
{
    if (scene.triangles.empty())
        throw InputError(scene.name + ": has points only, no faces: it occludes nothing");
}

std::vector<bool> left_out_of(const Roles& own, std::size_t count)
{
    if (own.occlude.empty() && own.baked.empty())
        return {};
    std::vector<bool> left_out(count);
    for (std::size_t t = 0; t < count; ++t)
        left_out[t] = !own.occludes(t) && !own.is_baked(t);
    return left_out;
}

}  // namespace surfelao
