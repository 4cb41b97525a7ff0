// What must not change the values at vertices. Mostly asked of rays, which answer two receivers
// that are the same but for rounding alike: what differs is the target's doing.
#include "bake/vertex_target.h"

#include "differences.h"
#include "engines/engine.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

std::vector<Occlusion> values_of(const Scene& scene, const EngineSettings& engine,
                                 const TargetSettings& settings = {})
{
    const auto mesh = std::make_shared<const Mesh>(make_mesh(scene, settings.normals));
    const VertexTarget target(mesh, settings);
    return target.values(
        solve(prepare(mesh->geometry, engine), target.receivers(), engine).occlusion);
}

EngineSettings by_rays(std::uint32_t count)
{
    EngineSettings settings;
    settings.engine = Engine::rays;
    settings.rays = count;
    return settings;
}

/// A box on a floor before a wall.
Scene furnished_corner()
{
    return scenes::wall_and_floor(4.0, 6) + scenes::box({0.5, -1, 0.1}, {1.5, 1, 1}, 2);
}

TargetSettings target_of(VertexValues values)
{
    TargetSettings settings;
    settings.values = values;
    return settings;
}

constexpr VertexValues kBoth[] = {VertexValues::fit, VertexValues::point};

TEST(Values, AreTheSameHoweverTheSceneIsTurned)
{
    const auto turned = [](glm::dvec3 p) {
        const double c = std::cos(0.7), s = std::sin(0.7);
        const glm::dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
        return glm::dvec3(q.x, c * q.y - s * q.z, s * q.y + c * q.z);
    };
    for (const Scene& scene : {scenes::bumpy_sphere(8), furnished_corner()}) {
        for (const VertexValues values : kBoth) {
            const TargetSettings settings = target_of(values);
            const double rms =
                rms_difference(values_of(scene, by_rays(4096), settings),
                               values_of(scenes::moved(scene, turned), by_rays(4096), settings));
            EXPECT_LT(rms, 0.002) << name_of(values);
        }
    }
}

TEST(Values, AreTheSameInAnyUnit)
{
    for (const Scene& scene : {scenes::bumpy_sphere(8), furnished_corner()}) {
        for (const VertexValues values : kBoth) {
            const TargetSettings settings = target_of(values);
            const std::vector<Occlusion> expected = values_of(scene, {}, settings);
            for (const double scale : {1e-3, 1e3}) {
                const Scene scaled =
                    scenes::moved(scene, [scale](glm::dvec3 p) { return scale * p; });
                EXPECT_LT(rms_difference(expected, values_of(scaled, {}, settings)), 1e-4)
                    << name_of(values) << " * " << scale;
            }
        }
    }
}

/// With vertices doubled along a border through the scene, as between charts of a texture.
/// `source`: of which vertex each is the double.
Scene with_seam(const Scene& whole, std::vector<std::uint32_t>& source)
{
    Scene scene = whole;
    const std::size_t count = whole.positions.size();
    std::vector<std::uint32_t> twin(count, 0);
    source.resize(count);
    for (std::uint32_t v = 0; v < count; ++v)
        source[v] = v;
    for (glm::uvec3& t : scene.triangles) {
        const glm::dvec3 sum = whole.positions[t.x] + whole.positions[t.y] + whole.positions[t.z];
        if (sum.x + 0.3 * sum.y < 0.1)
            continue;
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t& own = twin[t[corner]];
            if (own == 0) {
                own = static_cast<std::uint32_t>(scene.positions.size());
                scene.positions.push_back(whole.positions[t[corner]]);
                source.push_back(t[corner]);
            }
            t[corner] = own;
        }
    }
    scene.parts.resize(1);
    scene.parts[0].vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    scene.parts[0].triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    return scene;
}

TEST(Values, OfASmoothSurfaceShowNoSeamOfTheFile)
{
    TargetSettings settings;
    settings.normals.crease = 180.0f;
    const Scene whole = scenes::bumpy_sphere(12);
    std::vector<std::uint32_t> source;
    const Scene scene = with_seam(whole, source);
    const std::vector<Occlusion> expected = values_of(whole, by_rays(64), settings);
    const std::vector<Occlusion> found = values_of(scene, by_rays(64), settings);
    std::vector<bool> used(found.size());
    for (const glm::uvec3 t : scene.triangles)
        used[t.x] = used[t.y] = used[t.z] = true;
    int seam = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
        if (!used[v])
            continue;
        EXPECT_NEAR(found[v].occlusion, expected[source[v]].occlusion, 0.002) << v;
        seam += source[v] != v && used[source[v]];
    }
    EXPECT_GT(seam, 20);
}

// Twenty diagonals away, so that all lengths in the unit frame are others. What is left is the
// noise of the rays, and that the offsets of coarse triangles end at kMostOffset.
TEST(Values, AreTheSameBesideASpeckFarAway)
{
    const Scene speck = scenes::triangle({80, 0, 0}, {80, 1e-3, 0}, {80, 0, 1e-3});
    for (const Scene& scene : {scenes::bumpy_sphere(32), furnished_corner()}) {
        const std::vector<Occlusion> expected = values_of(scene, by_rays(2048));
        std::vector<Occlusion> found = values_of(scene + speck, by_rays(2048));
        found.resize(expected.size());
        EXPECT_LT(rms_difference(expected, found), 0.002);
    }
}

}  // namespace
}  // namespace surfelao
