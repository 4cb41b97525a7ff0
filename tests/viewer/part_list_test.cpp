#include "viewer/part_list.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

/// Two nodes below a group, one of them of a name with a star, and one material.
Scene scene_of_parts()
{
    Scene scene;
    scene.triangles.resize(9);
    scene.labels = {{LabelKind::node, "group", {{0, 9}}},
                    {LabelKind::material, "red", {{0, 9}}},
                    {LabelKind::node, "a", {{0, 4}}},
                    {LabelKind::node, "b*", {{4, 5}}}};
    return scene;
}

TEST(PartList, ShowsTheInnermostNodesWithTheirTicks)
{
    const Scene scene = scene_of_parts();
    const struct {
        PartChoice choice;
        PartTick a, b;
    } rows[] = {
        {{}, {"a", 4, true, true}, {"b*", 5, true, true}},
        {{.exclude = {"a"}}, {"a", 4, false, false}, {"b*", 5, true, true}},
        {{.receivers = {"a"}}, {"a", 4, true, true}, {"b*", 5, true, false}},
        {{.exclude = {"a"}, .receivers = {"?"}}, {"a", 4, false, true}, {"b*", 5, true, false}},
    };
    for (const auto& row : rows)
        EXPECT_EQ(part_ticks(scene, row.choice), (std::vector<PartTick>{row.a, row.b}));
}

// Whatever is ticked comes back from the choice that is made of it.
TEST(PartList, TicksBecomeNames)
{
    const Scene scene = scene_of_parts();
    for (int bits = 0; bits < 16; ++bits) {
        std::vector<PartTick> ticks = part_ticks(scene, {});
        ticks[0].occludes = (bits & 1) != 0;
        ticks[0].is_baked = (bits & 2) != 0;
        ticks[1].occludes = (bits & 4) != 0;
        ticks[1].is_baked = (bits & 8) != 0;
        const PartChoice choice = choice_of(ticks, {.occluders = {"x.ply"}});
        EXPECT_EQ(choice.occluders.size(), 1u);
        const bool is_any_baked = ticks[0].is_baked || ticks[1].is_baked;
        const bool is_simple =
            ticks[0].occludes == ticks[0].is_baked && ticks[1].occludes == ticks[1].is_baked;
        const bool comes_back = is_any_baked || is_simple;  // else nothing is left to be baked
        EXPECT_EQ(part_ticks(scene, choice) == ticks, comes_back) << bits;
    }
}

}  // namespace
}  // namespace surfelao
