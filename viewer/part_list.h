/// part_list.h: the parts of a scene as a list with two ticks each: who occludes, who is baked.
#pragma once

#include "bake/world.h"

#include <string>
#include <vector>

namespace surfelao {

struct PartTick {
    std::string name;
    std::uint64_t triangles = 0;
    bool occludes = true;
    bool is_baked = true;
    bool operator==(const PartTick&) const = default;
};

/// The labels of one kind, none of which lies within another: of nodes, objects, groups, meshes and
/// materials those that tell most parts apart. They live in the scene. O(labels).
[[nodiscard]] std::vector<const Label*> parting_labels(const Scene& scene);

/// Those, ticked as `choice` says.
[[nodiscard]] std::vector<PartTick> part_ticks(const Scene& scene, const PartChoice& choice);

/// `choice` with the names of these ticks in place of its patterns.
[[nodiscard]] PartChoice choice_of(const std::vector<PartTick>& ticks, PartChoice choice);

}  // namespace surfelao
