#include "bake/hidden_texels.h"

#include "bake/map_bake.h"
#include "scenes.h"
#include "seen_of_wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr std::uint32_t kSize = 128;
constexpr double kFloor = 8.0;  // wide
constexpr double kBox = 1.025;  // half as wide, and as high: its foot lies between texels' centres
constexpr double kTexel = kFloor / kSize;

/// The floor alone has a place in the map.
Mesh floor_with(const Scene& box)
{
    Scene floor = scenes::sheet({-kFloor / 2, -kFloor / 2, 0}, {kFloor, 0, 0}, {0, kFloor, 0}, 16);
    UvSet set;
    for (const glm::dvec3 p : floor.positions)
        set.values.emplace_back(p.x / kFloor + 0.5, p.y / kFloor + 0.5);
    set.corners = floor.triangles;
    Scene scene = floor + box;
    set.corners.resize(scene.triangles.size(), glm::uvec3(UvSet::kNone));
    scene.uvs.push_back(set);
    return make_mesh(std::move(scene));
}

MapBake bake_floor(const Mesh& mesh)
{
    return bake_map(mesh, {.size = {kSize, kSize}, .pages = {mesh.scene.uvs[0]}},
                    {.depth = MapDepth::whole}, {}, {});
}

/// What a place on the floor sees of the box: of each side that it is before.
double seen_of_box(glm::dvec2 p)
{
    double sum = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
        const double before = std::abs(p[axis]) - kBox, along = p[1 - axis];
        if (before > 0.0)
            sum += seen_of_wall(before, kBox, kBox - along, kBox + along);
    }
    return sum;
}

/// The next mip level.
Map halved(const Map& map)
{
    Map half(map.width / 2, map.height / 2, 1);
    for (std::uint32_t y = 0; y < half.height; ++y)
        for (std::uint32_t x = 0; x < half.width; ++x)
            for (const std::uint32_t k : {0u, 1u, 2u, 3u})
                half.values[half.index(x, y)] +=
                    map.values[map.index(2 * x + k % 2, 2 * y + k / 2)] / 4.0f;
    return half;
}

// What is shown beside the foot is never darker than what is there, in the next mip level neither.
TEST(HiddenTexels, LeaveNoFringeAtTheFootOfABox)
{
    const Mesh mesh = floor_with(scenes::box({-kBox, -kBox, 0}, {kBox, kBox, kBox}, 6));
    const MapBake bake = bake_floor(mesh);
    const double across = 2.0 * kBox / kTexel;  // texels
    EXPECT_NEAR(static_cast<double>(bake.hidden), 4.0 * kHiddenRings * (across - kHiddenRings),
                4.0 * across);
    const Map half = halved(bake.visibility[0]);
    double most = 0.0, most_beyond = 0.0, most_at_corner = 0.0;
    for (double along = -kBox - 0.1; along <= kBox + 0.1; along += 0.013)
        for (double before = 1e-3; before < 2.0 * kTexel; before += 0.2 * kTexel)
            for (const glm::dvec2 p : {glm::dvec2(kBox + before, along), {along, -kBox - before}}) {
                const glm::dvec2 uv = p / kFloor + 0.5;
                const double shown = 1.0 - fetch(bake.visibility[0], 0, uv);
                most = std::max({most, shown, 1.0 - fetch(half, 0, uv)});
                const glm::dvec2 from_side = glm::abs(p) - kBox;
                double& beyond = std::max(std::abs(from_side.x), std::abs(from_side.y)) < kTexel
                                     ? most_at_corner
                                     : most_beyond;
                beyond = std::max(beyond, shown - seen_of_box(p));
            }
    EXPECT_LT(most, 0.5 + 0.015);
    EXPECT_LT(most_beyond, 0.04);
    EXPECT_LT(most_at_corner, 0.08);  // where it falls from 1/2 to 1/4 at once, which texels smooth
    EXPECT_LT(bake.error->high, 0.02);
    // deep under the box all is as it was
    EXPECT_LT(fetch(bake.visibility[0], 0, glm::dvec2(0.5)), 0.001f);
}

TEST(HiddenTexels, AreNoneWhereNoClosedBodyFacesOutward)
{
    const Scene box = scenes::box({-kBox, -kBox, 0}, {kBox, kBox, kBox}, 6);
    Scene open = box;
    std::erase_if(open.triangles, [&](glm::uvec3 t) {
        return open.positions[t.x].z + open.positions[t.y].z + open.positions[t.z].z == 0.0;
    });
    open.parts[0].triangle_count = static_cast<std::uint32_t>(open.triangles.size());
    for (const Scene& scene : {open, scenes::flipped(box)})
        EXPECT_EQ(bake_floor(floor_with(scene)).hidden, 0u);
}

}  // namespace
}  // namespace surfelao
