#include "tree/disks/disks.h"

#include "differences.h"
#include "scenes.h"
#include "tests/vertex_receivers.h"
#include "tree/disks/brute_force.h"
#include "tree/disks/form_factor.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr double kPi = std::numbers::pi;

/// A scene as the engine gets it; every surfel casts from `side`.
struct World {
    Geometry geometry;
    std::vector<Receiver> receivers;
    Octree octree;

    explicit World(const Scene& scene, OccluderSide side = OccluderSide::back)
        : geometry(make_geometry(scene)), receivers(vertex_receivers(geometry))
    {
        const std::vector<Surfel> surfels = surfels_at_vertices(geometry);
        octree = build_octree(surfels, std::vector<OccluderSide>(surfels.size(), side));
    }

    /// Of triangles, as large as in the scene but for those above an area.
    World(const Scene& scene, OccluderSide side, double largest)
        : geometry(make_geometry(scene)), receivers(vertex_receivers(geometry))
    {
        const SurfelCloud cloud = surfels_of(geometry, largest);
        octree = build_octree(cloud.surfels, std::vector<OccluderSide>(cloud.surfels.size(), side));
    }

    /// Occlusion at a place of the scene's own coordinates.
    float at(glm::dvec3 position, glm::vec3 normal, const DiskOptions& options = {}) const
    {
        const glm::vec3 p((position - geometry.frame.centre) / geometry.frame.diagonal);
        const Receiver receiver = {p, normal};
        return solve_disks(octree, {&receiver, 1}, options).occlusion[0].occlusion;
    }

    std::vector<Occlusion> solve(const DiskOptions& options = {}) const
    {
        return solve_disks(octree, receivers, options).occlusion;
    }
};

/// The share of the hemisphere that a rectangle hides straight above at `height`, `a` by `b` from
/// the point overhead.
double level_quarter(double height, double a, double b)
{
    const double x = a / height;
    const double y = b / height;
    const double sx = std::sqrt(1.0 + x * x);
    const double sy = std::sqrt(1.0 + y * y);
    return (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy)) / (2.0 * kPi);
}

/// A whole disk above the horizon, exactly (disk_form_factor.h). c: from the receiver to its
/// centre.
double exact_disk(glm::dvec3 normal, glm::dvec3 c, glm::dvec3 m, double radius)
{
    const double x = radius * radius / glm::dot(c, c);
    const glm::dvec3 w = glm::normalize(c);
    const double sign = glm::dot(w, m) < 0.0 ? -1.0 : 1.0;
    const double h = sign * glm::dot(w, m);
    const double n_m = sign * glm::dot(normal, m);
    const double s = std::sqrt((1.0 - x) * (1.0 - x) + 4.0 * x * h * h);
    const double a = 2.0 * x * h * h / (s * (s + 1.0 - x));
    const double b = 2.0 * x * h / (s * (s + 1.0 + x));
    return a * n_m + b * (glm::dot(normal, w) - h * n_m);
}

/// The same by summing small pieces of the disk.
double summed_disk(glm::dvec3 normal, glm::dvec3 c, glm::dvec3 m, double radius)
{
    const glm::dvec3 u = glm::normalize(
        glm::cross(m, std::abs(m.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 v = glm::cross(m, u);
    constexpr int kRings = 60;
    constexpr int kSpokes = 120;
    double sum = 0.0;
    for (int ring = 0; ring < kRings; ++ring) {
        for (int spoke = 0; spoke < kSpokes; ++spoke) {
            const double r = radius * std::sqrt((ring + 0.5) / kRings);
            const double angle = 2.0 * kPi * spoke / kSpokes;
            const glm::dvec3 p = c + r * (std::cos(angle) * u + std::sin(angle) * v);
            const double d2 = glm::dot(p, p);
            sum += std::max(0.0, glm::dot(normal, p)) * std::abs(glm::dot(m, p)) / (d2 * d2);
        }
    }
    return sum * radius * radius / (kRings * kSpokes);
}

/// Disks of radius 1 about a receiver at the origin that looks up, wholly above its horizon.
template <class Visit>
void for_random_disks(double distance, const Visit& visit)
{
    std::mt19937 random(1);
    const auto uniform = [&] { return double(random()) / double(random.max()) * 2.0 - 1.0; };
    int visited = 0;
    while (visited < 200) {
        const glm::dvec3 w(uniform(), uniform(), uniform());
        const glm::dvec3 m(uniform(), uniform(), uniform());
        const double lowest = distance * glm::normalize(w).z -
                              std::sqrt(std::max(0.0, 1.0 - std::pow(glm::normalize(m).z, 2)));
        if (lowest <= 0.0)
            continue;
        visit(distance * glm::normalize(w), glm::normalize(m));
        ++visited;
    }
}

const glm::dvec3 kUp{0, 0, 1};

// ---- the formulas ---------------------------------------------------------------------------

TEST(DiskFormFactor, ClosedFormOfATiltedDiskMatchesItsSum)
{
    for (const double distance : {1.5, 3.0, 10.0}) {
        for_random_disks(distance, [&](glm::dvec3 c, glm::dvec3 m) {
            // 7200 pieces: the sum's own error
            EXPECT_NEAR(exact_disk(kUp, c, m, 1.0), summed_disk(kUp, c, m, 1.0), 1e-3);
        });
    }
}

// What is left out is of third order in x = R^2 / d^2, and x is below 1/9.
TEST(DiskFormFactor, FartherThanThreeRadiiItFollowsTheClosedForm)
{
    for (const double distance : {3.01, 5.0, 20.0}) {
        const double x = 1.0 / (distance * distance);
        for_random_disks(distance, [&](glm::dvec3 c, glm::dvec3 m) {
            const DiskShape disk = {glm::vec3(c), glm::vec3(m), float(kPi), float(kPi), true};
            EXPECT_NEAR(disk_form_factor(Kernel::cosine, glm::dvec3(0.0), kUp, disk),
                        exact_disk(kUp, c, m, 1.0), 4.0 * x * x * x + 1e-7);
        });
    }
}

TEST(DiskFormFactor, FacingDiskOnTheAxis)
{
    for (const double d : {0.01, 1.0, 3.1, 20.0}) {
        const DiskShape disk = {{0, 0, float(d)}, {0, 0, 1}, float(kPi), float(kPi), false};
        const double exact = 1.0 / (1.0 + d * d);
        EXPECT_NEAR(disk_form_factor(Kernel::cosine, glm::dvec3(0.0), kUp, disk), exact,
                    0.02 * exact)
            << "distance " << d;
    }
}

TEST(DiskFormFactor, OneSidedDisksOccludeOnlyFromBehindAndNothingBelowTheHorizon)
{
    DiskShape disk = {{0, 0, 2}, {0, 0, -1}, 1.0f, 1.0f, false};
    EXPECT_EQ(disk_form_factor(Kernel::cosine, glm::dvec3(0.0), kUp, disk), 0.0);
    disk.two_sided = true;
    EXPECT_GT(disk_form_factor(Kernel::cosine, glm::dvec3(0.0), kUp, disk), 0.05);
    disk.center.z = -2.0f;
    EXPECT_EQ(disk_form_factor(Kernel::cosine, glm::dvec3(0.0), kUp, disk), 0.0);
}

// A cluster whose normals cancel shows, two-sided, half its area to any side, as a sphere does.
TEST(DiskFormFactor, AFoldedClusterIsSeenFromEverySide)
{
    const DiskShape cluster = {{0, 0, 100}, {0, 0, 0}, 0.0f, 2.0f, true};
    EXPECT_NEAR(disk_form_factor(Kernel::cosine, glm::dvec3(0.0), kUp, cluster), 1.0 / (kPi * 1e4),
                1e-8);
}

TEST(DiskFormFactor, DistanceWeightFadesOverTheDisksWidth)
{
    const Definition limited = {.max_distance = 1.0f};
    const double area = kPi * 0.1 * 0.1;  // radius 0.1
    EXPECT_EQ(distance_weight(limited, 0.89, area), 1.0);
    EXPECT_NEAR(distance_weight(limited, 1.0, area), 0.5, 1e-12);
    EXPECT_EQ(distance_weight(limited, 1.11, area), 0.0);
    EXPECT_EQ(distance_weight({}, 1e9, area), 1.0);
    const Definition smooth = {.max_distance = 1.0f, .falloff = Falloff::smooth};
    EXPECT_NEAR(distance_weight(smooth, 0.5, area), 0.5625, 1e-7);
}

// ---- worlds whose sides are chosen here; all others with known answers are tests/engines/ ------

// Neighbouring disks dip under each other's horizon but for rounding.
TEST(DiskWorlds, AConvexBodyIsOpen)
{
    for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
        const World sphere(scenes::sphere({0, 0, 0}, 1.0, 16), side);
        for (const Occlusion& o : sphere.solve())
            EXPECT_LT(o.occlusion, 1e-3f);
    }
}

// Each sheet but the last sees the next one on its far side: the correction leaves the last.
TEST(DiskWorlds, SheetsBehindEachOtherCountOnce)
{
    const auto lid = [](double height) {
        return scenes::sheet({-1, -1, height}, {2, 0, 0}, {0, 2, 0}, 24);
    };
    const double one = 4.0 * level_quarter(1.0, 1.0, 1.0);
    const World three(lid(1.0) + lid(1.1) + lid(1.2), OccluderSide::both);
    const glm::dvec3 below(0.0);
    EXPECT_GT(three.at(below, kUp, {.passes = 1}), one + 0.3);
    EXPECT_NEAR(three.at(below, kUp, {.passes = 4}), one, 0.06);
}

TEST(DiskWorlds, BentNormalLeansAwayFromTheWall)
{
    const World world(scenes::wall_and_floor(1.0, 32), OccluderSide::both);
    const glm::vec3 p((glm::dvec3(0.1, 0, 1e-4) - world.geometry.frame.centre) /
                      world.geometry.frame.diagonal);
    const Receiver receiver = {p, {0, 0, 1}};
    const Occlusion o = solve_disks(world.octree, {&receiver, 1}, {}).occlusion[0];
    EXPECT_NEAR(glm::length(o.bent_normal), 1.0f, 1e-6f);
    EXPECT_GT(o.bent_normal.x, 0.3f);
    EXPECT_NEAR(o.bent_normal.y, 0.0f, 0.01f);
}

// ---- triangles ---------------------------------------------------------------------------------

/// A triangle with a corner at `a`, 2 by 2 wide, leaning; casting normal upwards.
Surfel leaning_triangle(glm::vec3 a)
{
    const glm::vec3 b = a + glm::vec3(2, 0, 0.5f), c = a + glm::vec3(0, 2, 1);
    const glm::vec3 across = glm::cross(b - a, c - a), centroid = (a + b + c) / 3.0f;
    return {centroid,
            0.5f * glm::length(across),
            glm::normalize(across),
            2.0f,
            {a - centroid, b - centroid}};
}

// Wholly above the horizon, cut by it with one corner or two above, and wholly below. 1e-4: what
// 400 by 400 pieces err by.
TEST(TriangleMoment, IsTheSumOverItsPiecesAboveTheHorizon)
{
    double covered = 0.0;
    for (const float height : {0.5f, -0.3f, -0.8f, -1.5f}) {
        const Surfel triangle = leaning_triangle({-0.7f, -0.6f, height});
        const glm::dvec3 corner(triangle.position + triangle.corners[0]);
        const glm::dvec3 u = glm::dvec3(triangle.corners[1] - triangle.corners[0]);
        const glm::dvec3 v =
            -glm::dvec3(triangle.corners[1]) - 2.0 * glm::dvec3(triangle.corners[0]);
        constexpr int kPieces = 400;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < kPieces; ++i) {
            for (int j = 0; i + j < kPieces; ++j) {
                // the last of a row is half a piece
                const double share = i + j + 1 < kPieces ? 1.0 : 0.5;
                const double shift = i + j + 1 < kPieces ? 0.5 : 1.0 / 3.0;
                const glm::dvec3 p = corner + ((i + shift) * u + (j + shift) * v) / double(kPieces);
                const double d = glm::length(p);
                if (p.z > 0.0)
                    sum += share * std::abs(glm::dot(p, glm::cross(u, v))) / std::pow(d, 4) * p;
            }
        }
        sum /= kPi * kPieces * kPieces;
        const glm::dvec3 moment = triangle_moment(glm::dvec3(triangle.position), kUp, triangle);
        EXPECT_NEAR(glm::distance(moment, sum), 0.0, 1e-4) << "height " << height;
        covered += moment.z;
    }
    EXPECT_GT(covered, 0.1);
}

// What no sum of disks at the triangles' centres can tell: a tall wall hides half of what stands
// at its foot, though it is four triangles and the foot nearer than their disks are wide.
TEST(DiskWorlds, AWallOfFewTrianglesHidesHalfAtItsFoot)
{
    const World world(scenes::sheet({-100, 0, 0}, {200, 0, 0}, {0, 0, 100}, 1), OccluderSide::both,
                      0.15);
    ASSERT_EQ(world.octree.surfels.size(), 4u);
    // to one side of the foot: what is `wide` and 100 high
    const auto exact = [](double distance, double wide) {
        const double slant = std::hypot(distance, 100.0);
        return (std::atan(wide / distance) - distance / slant * std::atan(wide / slant)) /
               (2.0 * kPi);
    };
    for (const double distance : {0.1, 1.0, 3.0}) {
        EXPECT_NEAR(world.at({7.0, -distance, 0.0}, {0, 0, 1}, {.opening = 0.0f, .passes = 1}),
                    exact(distance, 93.0) + exact(distance, 107.0), 1e-4)
            << distance;
    }
}

// The CPU's arcs are a fit within 4e-5 of themselves.
TEST(Disks, TrianglesOfAnySideEqualBruteForce)
{
    for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
        const World world(scenes::room({0, 0, 0}, {1, 2, 1}, 2), side, 2e-3);
        ASSERT_GT(world.octree.surfels.front().reach, 0.0f);
        for (const Definition& definition :
             {Definition{}, Definition{.max_distance = 0.3f, .falloff = Falloff::smooth}}) {
            const DiskOptions options = {.definition = definition, .opening = 0.0f, .passes = 3};
            const DiskResult tree = solve_disks(world.octree, world.receivers, options);
            const DiskResult brute =
                solve_disks_brute_force(world.octree, world.receivers, options);
            EXPECT_LT(difference(tree.occlusion, brute.occlusion).largest, 1e-4);
        }
    }
}

// ---- what must not matter, and what must ------------------------------------------------------

// The same sums in float and in another order: 1e-5 of a sum of at most a few.
TEST(Disks, OpeningZeroEqualsBruteForce)
{
    for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
        const World world(scenes::bumpy_sphere(10), side);
        for (const Definition& definition :
             {Definition{}, Definition{.kernel = Kernel::bunnell}, Definition{.max_distance = 0.2f},
              Definition{.max_distance = 0.3f, .falloff = Falloff::smooth},
              Definition{.ground = Ground{{0, 0, 1}, -0.25f}},
              Definition{.max_distance = 0.2f, .ground = Ground{{0, 0, 1}, -0.25f}},
              Definition{.max_distance = 0.3f,
              .falloff = Falloff::smooth,
              .ground = Ground{{0, 0, 1}, -0.1f}}}) {
            const DiskOptions options = {.definition = definition, .opening = 0.0f, .passes = 3};
            const DiskResult tree = solve_disks(world.octree, world.receivers, options);
            const DiskResult brute =
                solve_disks_brute_force(world.octree, world.receivers, options);
            EXPECT_LT(difference(tree.occlusion, brute.occlusion).largest, 5e-5)
                << "side " << int(side) << " kernel " << int(definition.kernel) << " distance "
                << definition.max_distance;
            ASSERT_EQ(tree.residuals.size(), brute.residuals.size());
            for (std::size_t i = 0; i < tree.residuals.size(); ++i)
                EXPECT_NEAR(tree.residuals[i], brute.residuals[i], 1e-5);
        }
    }
}

// The sum at every setting; corrected, only from where the correcting passes leave draft's opening.
TEST(Disks, ErrorFallsWithTheOpening)
{
    const auto expect_falling = [](const World& world, int passes,
                                   std::initializer_list<float> openings) {
        const std::vector<Occlusion> exact = world.solve({.opening = 0.0f, .passes = passes});
        double before = 1.0;
        for (const float opening : openings) {
            const double error =
                rms_difference(world.solve({.opening = opening, .passes = passes}), exact);
            EXPECT_LT(error, 0.75 * before) << passes << " passes, opening " << opening;
            before = error;
        }
        EXPECT_LT(before, 1e-3);
    };
    for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
        const World world(scenes::bumpy_sphere(24), side);
        expect_falling(world, 1, {kDraftOpening, kGoodOpening, kBestOpening, 0.1f});
        expect_falling(world, 2, {kDraftOpening, 0.15f, 0.08f, 0.04f});
    }
}

TEST(Disks, BytesDoNotDependOnTheInstructionSet)
{
    const World world(scenes::bumpy_sphere(16), OccluderSide::both, 1e-4);
    ASSERT_GT(world.octree.surfels.front().reach, 0.0f);
    const std::vector<Occlusion> widest = world.solve();
    int tried = 0;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & -left);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        EXPECT_TRUE(same_bytes(world.solve(), widest)) << hwy::TargetName(left & -left);
        hwy::SetSupportedTargetsForTest(0);
        ++tried;
    }
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GE(tried, 1);
}

// Another frame means other cells, so other clusters: no more than the opening's own error.
TEST(Disks, RotationScaleAndOffsetMatterLessThanTheOpening)
{
    const Scene scene = scenes::bumpy_sphere(24);
    const World plain(scene);
    const std::vector<Occlusion> expected = plain.solve();
    const double error = rms_difference(expected, plain.solve({.opening = 0.0f}));
    const Scene turned = scenes::moved(scene, [](glm::dvec3 p) {
        return glm::dvec3(0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z);
    });
    EXPECT_LT(rms_difference(World(turned).solve(), expected), 2.0 * error);
    for (const double scale : {1e-6, 1e6}) {
        const Scene placed =
            scenes::moved(scene, [&](glm::dvec3 p) { return scale * (p + glm::dvec3(100.0)); });
        EXPECT_LT(rms_difference(World(placed).solve(), expected), 1e-4) << "scale " << scale;
    }
}

TEST(Disks, OrderOfVerticesDoesNotMatter)
{
    Scene scene = scenes::bumpy_sphere(12);
    const std::vector<Occlusion> expected = World(scene).solve();
    std::reverse(scene.positions.begin(), scene.positions.end());
    const auto last = static_cast<std::uint32_t>(scene.positions.size() - 1);
    for (glm::uvec3& t : scene.triangles)
        t = last - t;
    std::vector<Occlusion> reversed = World(scene).solve();
    std::reverse(reversed.begin(), reversed.end());
    EXPECT_LT(difference(reversed, expected).largest, 1e-5);  // sums in another order
}

// Every pass after the first correction moves the emitters less, and corrections end by themselves.
TEST(Disks, CorrectionsSettle)
{
    for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
        const World world(scenes::bumpy_sphere(16), side);
        const DiskResult result =
            solve_disks(world.octree, world.receivers, {.opening = 0.5f, .passes = 40});
        ASSERT_GE(result.residuals.size(), 2u);
        EXPECT_LT(result.residuals.size(), 25u);
        EXPECT_LE(result.residuals.back(), kSettled);
        for (std::size_t i = 1; i < result.residuals.size(); ++i)
            EXPECT_LT(result.residuals[i], 0.8 * result.residuals[i - 1]);
    }
}

// They settle long before a hundred passes; shares ask for less.
TEST(Disks, ProgressEndsAtOne)
{
    const World world(scenes::nested_shells(2, 0.2, 6));
    for (const std::uint32_t shares : {1u, 3u}) {
        DiskOptions options;
        options.passes = 100;
        options.share = {0, shares};
        double last = 0.0;
        const DiskResult result =
            solve_disks(world.octree, world.receivers, options, [&](double done) {
                last = done;
                return true;
            });
        EXPECT_LT(result.residuals.size(), 99u);
        EXPECT_EQ(last, 1.0) << shares;
    }
}

TEST(Disks, StrengthScalesAndStaysInRange)
{
    const World world(scenes::bumpy_sphere(12));
    const std::vector<Occlusion> plain = world.solve();
    const std::vector<Occlusion> strong = world.solve({.strength = 3.0f});
    for (std::size_t i = 0; i < plain.size(); ++i)
        EXPECT_EQ(strong[i].occlusion, std::min(1.0f, 3.0f * plain[i].occlusion));
    for (const Occlusion& o : world.solve({.strength = 0.0f}))
        EXPECT_EQ(o.occlusion, 0.0f);
}

TEST(Disks, DegenerateScenesGiveNumbersInRange)
{
    Scene sliver = scenes::sheet({0, 0, 0}, {1e6, 0, 0}, {0, 1, 0}, 1);
    Scene needle;
    needle.positions = {{0, 0, 0}, {1, 1e-7, 0}, {2, 0, 0}, {1, 0, 1e-7}};
    needle.triangles = {{0, 1, 2}, {0, 2, 3}};
    Scene twice = scenes::box({0, 0, 0}, {1, 1, 1}, 2);
    twice = twice + twice;  // coincident faces
    const Scene folded = twice + scenes::flipped(twice);
    const Scene near = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4) +
                       scenes::sheet({0, 0, 1e-9}, {1, 0, 0}, {0, 1, 0}, 4);
    for (const Scene& scene : {sliver, needle, twice, folded, near}) {
        for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
            for (const float opening : {0.0f, kGoodOpening}) {
                const World world(scene, side);
                for (const Occlusion& o : world.solve({.opening = opening, .passes = 3})) {
                    EXPECT_GE(o.occlusion, 0.0f);
                    EXPECT_LE(o.occlusion, 1.0f);
                    const float length = glm::length(o.bent_normal);
                    EXPECT_TRUE(std::abs(length - 1.0f) < 1e-5f || length == 0.0f);
                }
            }
        }
    }
}

}  // namespace
}  // namespace surfelao
