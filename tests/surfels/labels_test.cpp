#include "surfels/labels.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

TEST(Labels, PatternsAreThoseOfAShell)
{
    const struct {
        const char* name;
        const char* pattern;
        bool is_called;
    } rows[] = {
        {"SkyDome", "SkyDome", true},
        {"SkyDome", "skydome", false},
        {"SkyDome", "Sky*", true},
        {"a/b", "a*b", true},
        {".hidden", "*", true},
        {"rock_LOD1", "*_LOD[1-9]", true},
        {"rock_LOD0", "*_LOD[1-9]", false},
        {"leaf?", "leaf\\?", true},
        {"leafs", "leaf\\?", false},
        {"dome", "dom", false},
    };
    for (const auto& row : rows)
        EXPECT_EQ(is_called(row.name, row.pattern), row.is_called)
            << row.name << " " << row.pattern;
}

// Names may come back, and groups of nodes may hold others of their name.
TEST(Labels, OfOneKindAndNameAreOne)
{
    LabelMaker maker;
    maker.add(LabelKind::material, "late", 7, 1);
    maker.add(LabelKind::node, "a", 0, 4);
    maker.add(LabelKind::node, "a", 1, 2);
    maker.add(LabelKind::node, "a", 4, 1);
    maker.add(LabelKind::node, "a", 6, 2);
    maker.add(LabelKind::mesh, "a", 0, 1);
    maker.add(LabelKind::node, "", 0, 1);
    maker.add(LabelKind::node, "empty", 3, 0);
    const std::vector<Label> labels = maker.finish();
    ASSERT_EQ(labels.size(), 3u);
    EXPECT_EQ(labels[0].name, "a");
    EXPECT_EQ(labels[0].ranges, (std::vector<Label::Range>{{0, 5}, {6, 2}}));
    EXPECT_EQ(triangle_count(labels[0]), 7u);
    EXPECT_EQ(labels[1].kind, LabelKind::mesh);
    EXPECT_EQ(labels[2].name, "late");
}

TEST(Labels, NearNamesComeFirst)
{
    std::vector<Label> labels;
    for (const char* name : {"Floor", "SkyDome", "SkyDome_low", "Sykdome", "Lamp"})
        labels.push_back({LabelKind::node, name, {{0, 1}}});
    EXPECT_EQ(names_near(labels, "skydome"),
              (std::vector<std::string>{"SkyDome", "SkyDome_low", "Sykdome"}));
    EXPECT_EQ(names_near(labels, "flor"), std::vector<std::string>{"Floor"});
    EXPECT_TRUE(names_near(labels, "xyz").empty());
}

}  // namespace
}  // namespace surfelao
