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
        const TexelLayout found = layout_for(square_with(row.sets), {.size = 64});
        EXPECT_EQ(found.uv_set, row.taken) << row.why_new;
        EXPECT_EQ(found.charts.has_value(), !row.taken);
        EXPECT_EQ(found.why_new.empty(), row.taken.has_value());
        EXPECT_NE(found.why_new.find(row.why_new), std::string::npos) << found.why_new;
        EXPECT_EQ(found.layout.pages.size(), 1u);
    }
    const Mesh mesh = square_with({folded});
    EXPECT_EQ(layout_for(mesh, {.size = 64, .uvs = UvChoice::file}).uv_set, 0u);
    EXPECT_THROW((void)layout_for(mesh, {.size = 64, .uvs = UvChoice::file, .uv_set = 1}),
                 InputError);
    EXPECT_THROW((void)layout_for(square_with({}), {.size = 64}, {.new_places = false}),
                 InputError);
}

TEST(TexelLayout, PrefersTheSetOfAMapThatTheFileHas)
{
    const auto asset = std::make_shared<const MappedAsset>();
    const TexelSettings settings{.size = 64};
    EXPECT_EQ(layout_for(square_with({flat, flat}, asset), settings).uv_set, 1u);
    EXPECT_EQ(layout_for(square_with({flat}, asset), settings).uv_set, 0u);
}

/// Triangle t has material t % 2.
class PaintedAsset : public SourceAsset {
public:
    explicit PaintedAsset(std::size_t triangles) : triangles_(triangles) {}
    [[nodiscard]] BaseColors base_colors() const override
    {
        BaseColors colors{.materials = std::vector<BaseColor>(2), .triangles = {}};
        for (std::uint32_t t = 0; t < triangles_; ++t)
            colors.triangles.push_back(t % 2);
        return colors;
    }

private:
    std::size_t triangles_;
};

// Each quad's two triangles cover the same half of it in the map: a page for each material has no
// overlap. With one that lies on another of its material only who insists gets pages.
TEST(TexelLayout, GivesEachMaterialAPageWhereTheyLieOnEachOther)
{
    for (const bool overlaps : {false, true}) {
        Scene scene = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
        UvSet& uvs = scene.uvs.emplace_back();
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            const auto quad = static_cast<double>(t / 2);
            const double left = overlaps && t == 2 ? 0.0 : quad / 16.0;
            for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1)})
                uvs.values.emplace_back(left + corner.x / 16.0, corner.y);
            const auto end = static_cast<std::uint32_t>(uvs.values.size());
            uvs.corners.emplace_back(end - 3, end - 2, end - 1);
        }
        scene.asset = std::make_shared<const PaintedAsset>(scene.triangles.size());
        const Mesh mesh = make_mesh(scene);
        const auto pages = [&](TexelSettings settings, const MapRoom& room) {
            settings.size = 64;
            const TexelLayout found = layout_for(mesh, settings, room);
            EXPECT_EQ(found.layout.materials.size(), found.layout.pages.size() == 2 ? 2u : 0u);
            return std::pair(found.layout.pages.size(), found.uv_set.has_value());
        };
        using Found = std::pair<std::size_t, bool>;
        EXPECT_EQ(pages({}, {}), overlaps ? Found(1, false) : Found(2, true));
        EXPECT_EQ(pages({.uvs = UvChoice::file}, {}), Found(2, true));
        EXPECT_EQ(pages({}, {.new_places = false}), Found(2, true));
        EXPECT_EQ(pages({}, {.several_pages = false}), Found(1, false));
    }
}

}  // namespace
}  // namespace surfelao
