// Clouds of points: worlds with a known answer, by every engine.
#include "bake/point_target.h"

#include "engines/threads.h"
#include "random.h"
#include "sampled_cloud.h"
#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace surfelao {
namespace {

using DrawPoint = std::function<glm::dvec3(Random&)>;

/// Points at random. normal_at: empty for none.
Scene cloud_of(std::uint32_t count, const DrawPoint& place,
               const std::function<glm::dvec3(glm::dvec3)>& normal_at = {})
{
    Random random(5);
    Scene cloud;
    cloud.name = "cloud";
    for (std::uint32_t i = 0; i < count; ++i) {
        cloud.positions.push_back(place(random));
        if (normal_at)
            cloud.normals.values.emplace_back(normal_at(cloud.positions.back()));
    }
    Part part;
    part.vertex_count = count;
    cloud.parts.push_back(part);
    return cloud;
}

/// The unit square.
glm::dvec3 on_floor(Random& random)
{
    const double x = random.share();
    return {x, random.share(), 0.0};
}

glm::dvec3 up_at(glm::dvec3)
{
    return {0.0, 0.0, 3.0};  // of any length
}

bool is_inside(glm::dvec3 p)
{
    return std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) < 0.4;
}

constexpr Engine kAllOfThem[] = {Engine::masks, Engine::disks, Engine::rays};

std::vector<Occlusion> answers_of(const PointTarget& target, Engine engine = Engine::masks)
{
    EngineSettings settings;
    settings.engine = engine;
    return bake_points(target, settings, 0).values;
}

std::vector<Occlusion> answers_of(const Scene& cloud, const TargetSettings& settings = {},
                                  Engine engine = Engine::masks)
{
    return answers_of(make_point_target(cloud, settings), engine);
}

double rms_difference(std::span<const Occlusion> a, std::span<const Occlusion> b)
{
    EXPECT_EQ(a.size(), b.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += std::pow(double{a[i].occlusion} - double{b[i].occlusion}, 2.0);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

TEST(Points, APlaneIsOpen)
{
    for (const bool has_normals : {true, false}) {
        const Scene plane = cloud_of(5000, on_floor, has_normals ? up_at : nullptr);
        const PointTarget target = make_point_target(plane, {});
        EXPECT_FALSE(target.cloud.is_flattened);
        // neither side is more open
        EXPECT_EQ(target.cloud.counts.weak, has_normals ? 0u : 5000u);
        for (const Engine engine : kAllOfThem) {
            const std::vector<Occlusion> answers = answers_of(target, engine);
            double sum = 0.0, most = 0.0, count = 0.0;
            for (std::size_t i = 0; i < answers.size(); ++i) {
                if (!is_inside(plane.positions[i]))
                    continue;
                sum += answers[i].occlusion;
                most = std::max(most, double{answers[i].occlusion});
                count += 1.0;
            }
            EXPECT_LE(sum / count, 0.003) << name_of(engine);
            EXPECT_LE(most, 0.05) << name_of(engine);
        }
    }
}

/// The n-th of a row of which any many lie evenly (Roberts. The Unreasonable Effectiveness of
/// Quasirandom Sequences. 2018): as regular as a scan.
glm::dvec2 even(std::uint32_t n)
{
    return glm::fract(glm::dvec2(0.7548776662466927, 0.5698402909980532) * double(n + 1));
}

TEST(Points, ASphereFromInsideIsClosed)
{
    std::uint32_t n = 0;
    const Scene sphere = cloud_of(
        5000,
        [&](Random&) {
            const glm::dvec2 at = even(n++);
            const double z = 2.0 * at.x - 1.0, a = 2.0 * std::numbers::pi * at.y;
            return glm::dvec3(std::sqrt(1.0 - z * z) * glm::dvec2(std::cos(a), std::sin(a)), z);
        },
        [](glm::dvec3 p) { return -p; });
    for (const Occlusion& answer : answers_of(sphere))
        EXPECT_GE(answer.occlusion, 0.99f);
    // rays go through the gaps between squares, which masks close
    double sum = 0.0;
    for (const Occlusion& answer : answers_of(sphere, {}, Engine::rays))
        sum += answer.occlusion;
    EXPECT_GE(sum / 5000.0, 0.9);
}

/// What a unit square covers at a height over its middle.
///     4 times a corner's: F = 1/(2 pi) (2 a / s atan(a / s)), s = sqrt(1 + a^2), a = side / 2 / h
/// (Siegel, Howell. Thermal Radiation Heat Transfer: a plane element under a rectangle's corner)
double square_over(double height)
{
    const double a = 0.5 / height, s = std::sqrt(1.0 + a * a);
    return 4.0 / (2.0 * std::numbers::pi) * 2.0 * a / s * std::atan(a / s);
}

TEST(Points, ParallelSheets)
{
    // far nearer than the spacing, back to back; and facing each other
    for (const auto& [gap, facing] : {std::pair{1e-4, -1.0}, std::pair{0.2, 1.0}}) {
        std::uint32_t n = 0;
        const Scene sheets = cloud_of(
            8000,
            [gap = gap, &n](Random&) {
                const std::uint32_t i = n++;
                return glm::dvec3(even(i), i % 2 == 0 ? 0.0 : gap);
            },
            [facing = facing](glm::dvec3 p) {
                return glm::dvec3(0.0, 0.0, p.z > 0.0 ? -facing : facing);
            });
        const PointTarget target = make_point_target(sheets, {});
        EXPECT_NEAR(target.cloud.spacing, std::sqrt(1.0 / 4000.0), 0.002) << "of one sheet";
        for (const Engine engine : {Engine::masks, Engine::rays}) {
            const std::vector<Occlusion> answers = answers_of(target, engine);
            double sum = 0.0, count = 0.0;
            for (std::size_t i = 0; i < answers.size(); ++i) {
                const glm::dvec3 p = sheets.positions[i];
                if (std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) > 0.1)
                    continue;
                sum += answers[i].occlusion;
                count += 1.0;
            }
            const double lift = kLift * target.cloud.spacing / std::sqrt(std::numbers::pi);
            EXPECT_NEAR(sum / count, facing < 0.0 ? 0.0 : square_over(gap - lift),
                        engine == Engine::masks ? 0.02 : 0.1)
                << name_of(engine);
        }
    }
}

/// A closed body with hollows that thousands of points tell.
Mesh blob()
{
    return make_mesh(scenes::moved(scenes::sphere({0, 0, 0}, 1.0, 24), [](glm::dvec3 p) {
        return p * (1.0 + 0.3 * std::sin(4.0 * p.x) * std::sin(4.0 * p.y + 1.0) *
                              std::sin(4.0 * p.z + 2.0));
    }));
}

TEST(Points, FarOffsetsAndDuplicatesChangeNothing)
{
    const Scene cloud = scenes::sampled(blob(), {.points = 3000}).cloud;
    const std::vector<Occlusion> answers = answers_of(cloud);
    Scene far = cloud;  // as in UTM
    for (glm::dvec3& p : far.positions)
        p += glm::dvec3(512'345.0, 5'345'678.0, 431.0);
    EXPECT_LT(rms_difference(answers_of(far), answers), 1e-3);

    Scene twice = cloud;
    twice.positions.insert(twice.positions.end(), cloud.positions.begin(), cloud.positions.end());
    twice.normals.values.insert(twice.normals.values.end(), cloud.normals.values.begin(),
                                cloud.normals.values.end());
    const PointTarget target = make_point_target(twice, {});
    EXPECT_EQ(target.cloud.counts.duplicates, 3000u);
    const std::vector<Occlusion> doubled = answers_of(target);
    for (const std::size_t first : {0u, 3000u})
        EXPECT_LT(rms_difference(std::span(doubled).subspan(first, 3000), answers), 3e-3);
}

TEST(Points, FewAndCollinearOnesAreOpen)
{
    struct FewPoints {
        std::uint32_t points;
        DrawPoint place;
        bool has_normals;
        std::uint64_t without_normal;
        float most;  ///< occlusion; squares along a line that rises are the treads of stairs
    };
    const DrawPoint on_line = [](Random& random) { return random.share() * glm::dvec3(1, 2, 3); };
    const DrawPoint at_one = [](Random&) { return glm::dvec3(7, 8, 9); };
    for (const FewPoints& c :
         {FewPoints{100, on_line, false, 100, 0.0f}, FewPoints{100, on_line, true, 0, 1.0f},
          FewPoints{1, on_floor, false, 1, 0.0f}, FewPoints{1, on_floor, true, 0, 0.0f},
          FewPoints{20, at_one, false, 20, 0.0f}, FewPoints{5, on_floor, false, 0, 0.0f}}) {
        const PointTarget target =
            make_point_target(cloud_of(c.points, c.place, c.has_normals ? up_at : nullptr), {});
        EXPECT_EQ(target.cloud.counts.without_normal, c.without_normal);
        for (const Engine engine : kAllOfThem) {
            EngineSettings settings;
            settings.engine = engine;
            const VertexBake bake = bake_points(target, settings, 50);
            EXPECT_EQ(bake.error.has_value(), c.without_normal == 0);
            for (const Occlusion& answer : bake.values)
                EXPECT_LE(answer.occlusion, c.most) << c.points << ' ' << name_of(engine);
        }
    }
}

/// Of a sampled mesh: answers against the mesh's own, and how many normals look inward.
struct Judged {
    double rmse = 0.0;
    double turned = 0.0;  ///< share
};

Judged judge(const Mesh& mesh, const scenes::CloudSampling& sampling)
{
    const scenes::SampledCloud sampled = scenes::sampled(mesh, sampling);
    const std::vector<Receiver> receivers =
        receivers_at(mesh.geometry, mesh.surface, sampled.samples);
    const std::vector<Occlusion> truth =
        solve(prepare(mesh.geometry), receivers, {.quality = kBest}).occlusion;
    const PointTarget target = make_point_target(sampled.cloud, {});
    EXPECT_EQ(target.cloud.is_flattened, sampling.noise > 0.0);
    Judged judged{rms_difference(answers_of(target), truth)};
    for (std::size_t i = 0; i < receivers.size(); ++i)
        judged.turned += glm::dot(target.cloud.normals[i], receivers[i].normal) < 0.0f;
    judged.turned /= static_cast<double>(receivers.size());
    return judged;
}

TEST(Points, AScanIsAsItsSurface)
{
    const Mesh mesh = blob();
    EXPECT_LE(judge(mesh, {.points = 6000}).rmse, 0.012);
    const Judged noisy = judge(mesh, {.points = 6000, .noise = 0.3, .has_normals = false});
    EXPECT_LE(noisy.rmse, 0.03);
    EXPECT_LE(noisy.turned, 0.005);
    EXPECT_LE(judge(mesh, {.points = 6000, .has_normals = false}).turned, 0.005);
}

// So many that only some of them are asked.
TEST(Points, NoiseOfManyIsThatOfFew)
{
    const Mesh mesh = blob();
    const auto cloud_with = [&](std::uint32_t points) {
        return make_point_cloud(scenes::sampled(mesh, {.points = points, .noise = 0.3}).cloud);
    };
    const PointCloud many = cloud_with(140'000), few = cloud_with(20'000);
    EXPECT_TRUE(many.is_flattened);
    EXPECT_NEAR(many.noise, few.noise, 0.05f * few.noise);
}

// A side of a plate that is nearly as closed as its inside, and the open side below it, so near
// that they are neighbours.
/// Four points, two on each side of a thin sheet.
PointCloud thin_sheet()
{
    PointCloud cloud;
    cloud.positions = {{0, 0, 0}, {0.01f, 0, 0}, {0, 0, -0.01f}, {0.01f, 0, -0.01f}};
    cloud.normals.assign(4, glm::vec3(0, 0, 1));
    cloud.occluders = {0, 1, 2, 3};
    cloud.order = {2, 0, 3, 1};  // neighbours are places in it
    cloud.is_unoriented = true;
    cloud.neighbours.resize(4);
    for (std::uint32_t i = 0; i < 4; ++i) {
        cloud.neighbours[i].fill(PointCloud::kNobody);
        std::size_t count = 0;
        for (std::uint32_t other = 0; other < 4; ++other) {
            if (other != i)
                cloud.neighbours[i][count++] = other;
        }
    }
    return cloud;
}

// Nor has it where only one point of each side was asked.
TEST(Points, TheOtherSideOfAThinSheetHasNoVote)
{
    const std::vector<Occlusion> front{{0.9f, {}}, {0.9f, {}}, {1.0f, {}}, {1.0f, {}}};
    const std::vector<Occlusion> back{{0.95f, {}}, {0.95f, {}}, {0.2f, {}}, {0.2f, {}}};
    const std::vector<glm::vec3> right{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}, {0, 0, -1}};
    for (const std::vector<std::uint32_t>& voters :
         {std::vector<std::uint32_t>{0, 1, 2, 3}, {1, 2}}) {
        PointCloud cloud = thin_sheet();
        std::vector<Occlusion> sides[2];
        for (const std::uint32_t voter : voters) {
            sides[0].push_back(front[voter]);
            sides[1].push_back(back[voter]);
        }
        orient(cloud, voters, sides[0], sides[1]);
        EXPECT_EQ(cloud.normals, right);
    }
}

TEST(Points, NormalsAreTurnedAsToldTo)
{
    const Scene floor = cloud_of(500, on_floor, up_at);
    const auto all_face = [](const PointCloud& cloud, glm::vec3 way) {
        return std::ranges::all_of(cloud.normals,
                                   [&](glm::vec3 normal) { return glm::dot(normal, way) > 0.99f; });
    };
    const glm::vec3 up(0, 0, 1);
    EXPECT_TRUE(all_face(make_point_target(floor, {}).cloud, up));
    const PointTarget below = make_point_target(floor, {.viewpoint = glm::dvec3(0.5, 0.5, -100.0)});
    EXPECT_TRUE(all_face(below.cloud, -up));
    EXPECT_EQ(below.orientation, Orientation::viewpoint);

    Scene scanned = cloud_of(500, on_floor);
    scanned.viewpoint = glm::dvec3(0.5, 0.5, 100.0);
    EXPECT_TRUE(all_face(make_point_target(scanned, {}).cloud, up));

    // the sky over a wall of points
    const Scene wall = cloud_of(500, [](Random& random) {
        const double y = random.share();
        return glm::dvec3(0.0, y, random.share());
    });
    const PointTarget sky = make_point_target(wall, {.normals = {.source = NormalSource::up}});
    for (const Receiver& receiver : receivers_at(sky.cloud, sky.cloud.order))
        EXPECT_EQ(receiver.normal, up);
}

TEST(Points, OutliersDoNotOcclude)
{
    Scene floor = cloud_of(2000, on_floor, up_at);
    const std::vector<Occlusion> alone = answers_of(floor);
    for (int i = 0; i < 3; ++i) {
        floor.positions.emplace_back(0.5 + 0.01 * i, 0.5, 0.4);
        floor.normals.values.emplace_back(0, 0, 1);
        ++floor.parts[0].vertex_count;
    }
    const PointTarget target = make_point_target(floor, {});
    EXPECT_EQ(target.cloud.counts.outliers, 3u);
    const std::vector<Occlusion> answers = answers_of(target);
    EXPECT_LT(rms_difference(std::span(answers).first(2000), alone), 1e-3);
}

TEST(Points, ThinnedOccludersSayNearlyTheSame)
{
    const scenes::SampledCloud sampled = scenes::sampled(blob(), {.points = 20'000});
    const PointTarget thinned = make_point_target(
        sampled.cloud, {.occluder_spacing = Length{2.0 * sampled.spacing, false}});
    EXPECT_EQ(thinned.cloud.counts.thinned + thinned.cloud.occluders.size(), 20'000u);
    EXPECT_LT(thinned.cloud.occluders.size(), 8'000u);
    EXPECT_LT(rms_difference(answers_of(thinned), answers_of(sampled.cloud)), 0.02);
}

TEST(Points, StatedErrorIsThatOfTheEngine)
{
    const PointTarget target =
        make_point_target(scenes::sampled(blob(), {.points = 1000}).cloud, {});
    EngineSettings masks, rays;
    rays.engine = Engine::rays;
    rays.rays = 2048;
    const VertexBake bake = bake_points(target, masks, 400);
    const std::vector<Occlusion> truth = bake_points(target, rays, 0).values;
    // what errs by more has mostly no well-defined answer, and is left out
    std::vector<Occlusion> near = bake.values;
    for (std::size_t i = 0; i < near.size(); ++i)
        if (std::abs(near[i].occlusion - truth[i].occlusion) > kSuspicious)
            near[i] = truth[i];
    const double rmse = rms_difference(near, truth);
    EXPECT_NEAR(bake.error->rmse, rmse, 0.3 * rmse);
    EXPECT_EQ(bake.error->points + bake.error->ill_defined, 400u);

    const VertexBake asked = bake_points_to_error(target, masks, 0.01, 400);
    EXPECT_TRUE(asked.is_met);
    EXPECT_LE(asked.error->high, 0.01);
}

// What found the sides answers the bake too, and is asked only what it was prepared for.
TEST(Points, WhatIsReadyIsNotPreparedAnew)
{
    const Scene scan = scenes::sampled(blob(), {.points = 1000, .has_normals = false}).cloud;
    std::optional<Prepared> masks;
    const PointTarget target = make_point_target(scan, {}, {}, &masks);
    ASSERT_TRUE(masks);
    for (const Engine engine : {Engine::masks, Engine::rays}) {
        EngineSettings settings;
        settings.engine = engine;
        const VertexBake own = bake_points(target, settings, 0);
        const VertexBake ready = bake_points(target, settings, 0, {}, &*masks);
        EXPECT_EQ(ready.values, own.values);
        EXPECT_EQ(ready.seconds.tree == 0.0, engine == Engine::masks);
    }
}

TEST(Points, AnyNumberOfThreadsGivesTheSameBytes)
{
    const Scene cloud =
        scenes::sampled(blob(), {.points = 5000, .noise = 0.3, .has_normals = false}).cloud;
    const std::vector<Occlusion> many = answers_of(cloud);
    const ThreadLimit one(1);
    const std::vector<Occlusion> single = answers_of(cloud);
    for (std::size_t i = 0; i < many.size(); ++i) {
        ASSERT_EQ(many[i].occlusion, single[i].occlusion);
        ASSERT_EQ(many[i].bent_normal, single[i].bent_normal);
    }
}

TEST(Points, WrongSettingsAreRefused)
{
    const Scene cloud = cloud_of(10, on_floor);
    EXPECT_THROW(check_target(cloud, {.normals = {.source = NormalSource::flat}}, {}),
                 SettingsError);
    EXPECT_THROW(make_point_target(cloud, {.normals = {.source = NormalSource::file}}), InputError);
    EXPECT_THROW(make_point_target(cloud, {.occluder_spacing = Length{1e-9, false}}), InputError);
    const Scene mesh = scenes::sphere({0, 0, 0}, 1.0, 2);
    EXPECT_THROW(check_target(mesh, {.viewpoint = glm::dvec3(0.0)}, {}), SettingsError);
    EXPECT_THROW(check_target(mesh, {.occluder_spacing = Length{1.0, true}}, {}), SettingsError);
    EXPECT_THROW(check_target(mesh, {.normals = {.source = NormalSource::up}}, {}), SettingsError);
    EXPECT_NO_THROW(check_target(mesh, {}, {.exclude = {"a"}}));
    EXPECT_THROW(check_target(cloud, {}, {.exclude = {"a"}}), SettingsError);
}

}  // namespace
}  // namespace surfelao
