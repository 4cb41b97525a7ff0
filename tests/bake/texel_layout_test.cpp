#include "bake/texel_layout.h"

#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>

#include <functional>

namespace surfelao {
namespace {

/// A file with a map over set 1.
class MappedAsset : public SourceAsset {
public:
    [[nodiscard]] std::optional<std::uint32_t> occlusion_uvs() const override { return 1; }
};

using Place = std::function<glm::dvec2(glm::dvec3)>;

UvSet set_of(const Scene& scene, const Place& place)
{
    UvSet set;
    for (const glm::dvec3 p : scene.positions)
        set.values.push_back(place(p));
    return set;
}

glm::dvec2 flat(glm::dvec3 p)
{
    return {p.x, p.y};
}

/// A unit square with these sets.
Mesh square_with(const std::vector<Place>& places, std::shared_ptr<const SourceAsset> asset = {})
{
    Scene scene = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
    for (const Place& place : places)
        scene.uvs.push_back(place ? set_of(scene, place) : UvSet{});
    scene.asset = std::move(asset);
    return make_mesh(std::move(scene));
}

TEST(TexelLayout, TakesTheFilesCoordinatesWhereTheyCanHoldAMap)
{
    const Place folded = [](glm::dvec3 p) { return glm::dvec2(std::abs(p.x - 0.5), p.y); };
    const Place bricks = [](glm::dvec3 p) { return 9.0 * flat(p); };
    const Place line = [](glm::dvec3 p) { return glm::dvec2(p.x, 0.5); };
    const struct {
        std::vector<Place> sets;
        std::optional<std::uint32_t> taken;
        const char* why_new;
    } rows[] = {{{flat}, 0, ""},
                {{nullptr, flat}, 1, ""},
                {{}, {}, "there are no texture coordinates"},
                {{folded}, {}, "lie on each other at"},
                {{bricks}, {}, "times over"},
                {{line}, {}, "no triangle has an area"}};
    for (const auto& row : rows) {
        const TexelLayout found = layout_for(square_with(row.sets), {.size = 64}, true);
        EXPECT_EQ(found.uv_set, row.taken) << row.why_new;
        EXPECT_EQ(found.charts.has_value(), !row.taken);
        EXPECT_EQ(found.why_new.empty(), row.taken.has_value());
        EXPECT_NE(found.why_new.find(row.why_new), std::string::npos) << found.why_new;
        EXPECT_EQ(found.layout.pages.size(), 1u);
    }
    const Mesh mesh = square_with({folded});
    EXPECT_EQ(layout_for(mesh, {.size = 64, .uvs = UvChoice::file}, true).uv_set, 0u);
    EXPECT_THROW((void)layout_for(mesh, {.size = 64, .uvs = UvChoice::file, .uv_set = 1}, true),
                 InputError);
    EXPECT_THROW((void)layout_for(square_with({}), {.size = 64}, false), InputError);
}

TEST(TexelLayout, PrefersTheSetOfAMapThatTheFileHas)
{
    const auto asset = std::make_shared<const MappedAsset>();
    const TexelSettings settings{.size = 64};
    EXPECT_EQ(layout_for(square_with({flat, flat}, asset), settings, true).uv_set, 1u);
    EXPECT_EQ(layout_for(square_with({flat}, asset), settings, true).uv_set, 0u);
}

}  // namespace
}  // namespace surfelao
