/// roles.h: who occludes and who is asked, triangle by triangle. Internal to bake/.
#pragma once

#include "bake/cut_out.h"
#include "bake/world.h"
#include "surfels/scene.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// What the triangles of a scene do; empty lists: all of them.
struct Roles {
    std::vector<bool> occlude, baked;
    CutOut cut;  ///< of what occludes

    [[nodiscard]] bool occludes(std::size_t triangle) const
    {
        return occlude.empty() || occlude[triangle];
    }
    [[nodiscard]] bool is_baked(std::size_t triangle) const
    {
        return baked.empty() || baked[triangle];
    }
};

/// One per input, then one per other scene, which is not baked; materials apart
/// (open_materials). Throws InputError for a pattern that means nothing in any of them.
[[nodiscard]] std::vector<Roles> roles_of(std::span<const Scene> inputs,
                                          std::span<const Scene> others, const PartChoice& choice);

/// Takes from what occludes where light goes through, and says so.
void open_materials(const Scene& scene, ClearSurfaces clear, Roles& roles,
                    std::vector<std::string>& notes);

/// Throws InputError where nothing of an input is left to be baked. inputs: how many there are.
void check_baked(const Scene& scene, const Roles& own, std::size_t inputs);

/// Throws InputError where a file that is to occlude has points only.
void check_occluder(const Scene& scene);

/// Scene triangles that neither occlude nor are baked; empty: there are none.
[[nodiscard]] std::vector<bool> left_out_of(const Roles& own, std::size_t count);

}  // namespace surfelao
