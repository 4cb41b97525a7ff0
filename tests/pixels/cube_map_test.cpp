#include "pixels/cube_answer.h"

#include "cube_twin.h"
#include "looks.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

/// A scene with all that maps of it need.
struct CubeScene {
    explicit CubeScene(const Scene& scene)
        : mesh(make_mesh(scene)),
          drawn(test_context(), mesh.geometry, mesh.surface),
          occluders(mesh.geometry),
          screen(test_context())
    {
    }
    CubeWorld world() { return {test_context(), mesh, drawn, occluders, screen}; }
    CubeMap map(glm::vec3 centre, const CubeSettings& settings)
    {
        CubeSeconds seconds;
        return make_cube_map(world(), centre, settings, seconds);
    }
    PixelView view(const View& from, PictureSize size)
    {
        return {test_context(), mesh, drawn, from, size};
    }

    Mesh mesh;
    DrawnMesh drawn;
    Occluders occluders;
    ScreenSpace screen;
};

CubeSettings settings_with(int size, float max_distance = std::numeric_limits<float>::infinity())
{
    CubeSettings settings;
    settings.size = size;
    settings.definition.max_distance = max_distance;
    return settings;
}

/// A wide view along a direction that is at right angles to up.
View looking(glm::vec3 eye, glm::vec3 forward, glm::vec3 up, float half_width, float half_height)
{
    View view;
    view.eye = eye;
    view.forward = glm::normalize(forward);
    view.up = up;
    view.right = glm::cross(view.forward, up);
    view.lens = {{-half_width, -half_height}, {half_width, half_height}, false};
    return view;
}

double rms_difference(const std::vector<float>& a, const std::vector<Occlusion>& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += std::pow(double{a[i]} - double{b[i].occlusion}, 2.0);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(CubeMap, NormalsComeBackFromTwoBytes)
{
    double worst = 1.0;
    for (int i = 0; i < 1000; ++i) {
        const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / 1000.0f;
        const float turn = 2.39996f * static_cast<float>(i), r = std::sqrt(1.0f - z * z);
        const glm::vec3 n(r * std::cos(turn), r * std::sin(turn), z);
        worst = std::min<double>(worst, glm::dot(n, direction_of(octahedral_of(n))));
    }
    EXPECT_GT(worst, std::cos(3.14159 / 180.0));
}

// The thesis: 11,010,048 bytes at 512.
TEST(CubeMap, TakesSevenBytesATexel)
{
    CubeSight sight;
    sight.size = 512;
    EXPECT_EQ(cube_map_of(sight, {}).bytes(), 11'010'048u);
    CubeProjector projector(test_context());
    CubeScene scene(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1));
    projector.add(scene.map({0, 0, 0.3f}, settings_with(32)));
    projector.add(scene.map({0, 0, 0.4f}, settings_with(32)));
    EXPECT_EQ(projector.bytes(), 2u * 7 * 6 * 32 * 32);
}

TEST(CubeMap, OfAPlaneIsOpenAndInsideOfASphereClosed)
{
    CubeScene plane(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 4));
    const CubeMap over = plane.map({0.1f, 0, 0.2f}, settings_with(32));
    EXPECT_EQ(std::ranges::max(over.occlusion), 0);
    EXPECT_LT(std::ranges::min(over.distances), 0.21f);

    CubeScene sphere(scenes::flipped(scenes::sphere({0, 0, 0}, 1.0, 16)));
    const CubeMap inside = sphere.map({0.05f, 0.1f, 0}, settings_with(32));
    EXPECT_GE(std::ranges::min(inside.occlusion), 250);  // masks' own error at the sphere's facets
}

TEST(CubeMap, RefusesTheInsideOfABodyAndSizesOutOfRange)
{
    CubeScene box(scenes::box({-1, -1, -1}, {1, 1, 1}, 2));
    EXPECT_THROW((void)box.map({0.05f, 0, 0}, settings_with(32)), InputError);
    EXPECT_THROW((void)box.map({0, 0, 1}, settings_with(kLeastCubeSize - 1)), SettingsError);
    EXPECT_THROW((void)box.map({0, 0, 1}, settings_with(kMostCubeSize + 1)), SettingsError);
}

// Every pixel is answered, every texel has the engine's answer at its own receiver, and what the
// picture shows is what its pixels would have been told themselves.
TEST(CubeMap, CoversAClosedRoomFromAnywhere)
{
    CubeScene room(scenes::room({-1, -0.8, -1.2}, {1, 0.8, 1.2}, 8));
    const CubeSettings settings = settings_with(128, 0.5f);
    const glm::vec3 centre(0.05f, 0.02f, -0.1f);
    const CubeSight sight =
        look_around(test_context(), room.mesh, room.drawn, centre, settings.size);
    ASSERT_EQ(sight.texels.size(), 6u * 128 * 128);
    SolveSettings solving;
    solving.definition = settings.definition;
    const Prepared& masks = room.occluders.prepared_for({});
    const std::vector<Occlusion> answers = solve(masks, sight.receivers, solving).occlusion;
    CubeProjector projector(test_context());
    projector.add(room.map(centre, settings));
    for (std::size_t i = 0; i < answers.size(); ++i)
        ASSERT_EQ(projector.maps()[0].occlusion[sight.texels[i]],
                  std::lround(255.0f * answers[i].occlusion));

    const PixelView view =
        room.view(looking({-0.1f, 0.05f, 0.2f}, {0.3f, 0, -1}, {0, 1, 0}, 0.8f, 0.6f), {160, 120});
    CubeAnswer answer = answer_from_maps(view, projector);
    EXPECT_LE(answer.holes,
              2u);  // a pixel in a corner, right in line with a texel of the next wall
    EXPECT_EQ(answer.occlusion.size(), 160u * 120u);
    solve_holes(answer, view, room.world(), settings);
    const std::vector<Occlusion> direct = solve(masks, view.seen().receivers, solving).occlusion;
    EXPECT_LT(rms_difference(answer.occlusion, direct), 0.005);
}

glm::dvec3 turned(glm::dvec3 p)
{
    return {p.z, p.y, -p.x};
}

/// A pattern in space as answers, so that no engine's directions show.
std::vector<Occlusion> pattern_at(const CubeSight& sight, bool turn)
{
    std::vector<Occlusion> answers;
    for (const Receiver& receiver : sight.receivers) {
        const glm::vec3 p = receiver.position;
        const glm::vec3 q = turn ? glm::vec3(-p.z, p.y, p.x) : p;
        answers.push_back({0.5f + 0.2f * std::sin(9.0f * q.x) + 0.2f * std::cos(8.0f * q.z + q.y),
                           glm::vec3(0.0f)});
    }
    return answers;
}

/// What maps with the pattern show of a body, or of the body turned; -1 where nothing is shown.
std::vector<float> shown_pattern(bool turn)
{
    const auto place = [turn](glm::vec3 p) { return turn ? glm::vec3(turned(glm::dvec3(p))) : p; };
    const Scene shape = scenes::bumpy_sphere(12);
    CubeScene scene(turn ? scenes::moved(shape, turned) : shape);
    CubeProjector projector(test_context());
    for (const glm::vec3 centre : {glm::vec3(0.5f, 0.3f, 0.6f), glm::vec3(-0.2f, 0.4f, 0.7f)}) {
        const CubeSight sight =
            look_around(test_context(), scene.mesh, scene.drawn, place(centre), 128);
        projector.add(cube_map_of(sight, pattern_at(sight, turn)));
    }
    const PixelView view = scene.view(
        looking(place({0, 0.1f, 1.3f}), place({0, 0, -1}), {0, 1, 0}, 0.4f, 0.4f), {96, 96});
    const CubeAnswer answer = answer_from_maps(view, projector);
    std::vector<float> values(96u * 96u, -1.0f);
    for (std::size_t i = 0; i < answer.occlusion.size(); ++i) {
        if (answer.hole[i] == 0)
            values[view.seen().pixels[i]] = answer.occlusion[i];
    }
    return values;
}

// The world turned by 90 degrees is what a map turned the other way sees: other faces, the same
// picture.
TEST(CubeMap, FacesDoNotShow)
{
    const std::vector<float> plain = shown_pattern(false), other = shown_pattern(true);
    int different = 0, shown = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        shown += plain[i] >= 0.0f ? 1 : 0;
        different += std::abs(plain[i] - other[i]) > 1.0f / 255.0f ? 1 : 0;
    }
    EXPECT_GT(shown, 1500);
    EXPECT_LE(different, shown / 1000);
}

/// Pixels that maps answer by the plain twin.
struct TwinCount {
    int answered = 0, other = 0;  ///< other: the shader's answer is another one
};
TwinCount compare_with_twin(const PixelView& view, CubeProjector& projector,
                            const TwinTests& tests = {}, std::vector<float> weights = {})
{
    const View& from = view.g_buffer().view();
    std::vector<glm::vec3> centres;
    for (const CubeMap& map : projector.maps())
        centres.push_back(map.centre);
    weights.resize(centres.size(), 1.0f);
    for (std::size_t i = 0; i < weights.size(); ++i)
        projector.set_weight(i, weights[i]);
    const std::vector<ProjectedMap> used = nearest_maps(centres, weights, from.eye);
    const CubeAnswer shader = answer_from_maps(view, projector);
    const std::vector<glm::vec4> surface = view.g_buffer().read_surface();
    const SeenPixels& seen = view.seen();
    TwinCount count;
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
        const std::uint32_t pixel = seen.pixels[i];
        const auto columns = static_cast<std::uint32_t>(seen.width);
        const PixelRay ray =
            pixel_ray(from.lens, seen.width, seen.height,
                      glm::vec2(pixel % columns, pixel / columns) + glm::vec2(0.5f));
        const glm::vec3 point = to_world(from, ray.origin + surface[pixel].w * ray.direction);
        const glm::vec3 normal = to_world(from, glm::vec3(surface[pixel])) - from.eye;
        const TwinAnswer twin = twin_answer(projector.maps(), used, point, normal, tests);
        count.answered += twin.share > 0.0f ? 1 : 0;
        count.other += std::abs(twin.share - shader.share[i]) > 1e-3f ||
                               std::abs(twin.occlusion - shader.occlusion[i]) > 1e-3f
                           ? 1
                           : 0;
    }
    return count;
}

// All tests of a texel are thresholds, so that a rounding may turn a pixel over.
TEST(CubeProjector, IsItsPlainTwin)
{
    CubeScene scene(scenes::bumpy_sphere(12));
    CubeProjector projector(test_context());
    for (const glm::vec3 centre :
         {glm::vec3(0.5f, 0.3f, 0.6f), glm::vec3(-0.2f, 0.4f, 0.7f), glm::vec3(0.1f, -0.6f, 0.4f)})
        projector.add(scene.map(centre, settings_with(64)));
    const PixelView view =
        scene.view(looking({0, 0.1f, 1.3f}, {0, 0, -1}, {0, 1, 0}, 0.45f, 0.4f), {108, 96});
    const TwinCount count = compare_with_twin(view, projector);
    EXPECT_GT(count.answered, 1500);
    EXPECT_LE(count.other, 6);
    // maps that fade
    const TwinCount faded = compare_with_twin(view, projector, {}, {0.6f, 1.0f, 0.1f});
    EXPECT_EQ(faded.answered, count.answered);
    EXPECT_LE(faded.other, 6);
}

// A sheet two footprints behind another one, which a map sees: nothing of it is the sheet's, from
// whichever side it is looked at. Three footprints without a word of normals let it through.
TEST(CubeProjector, DoesNotLeakThroughAWall)
{
    const auto sheet = [](double z) { return scenes::sheet({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, 1); };
    CubeScene scene(sheet(0.0) + sheet(-0.1));
    const float wall = scene.mesh.geometry.positions[0].z;
    const float hidden = scene.mesh.geometry.positions.back().z;
    const float gap = wall - hidden;
    ASSERT_GT(gap, 0.0f);
    CubeProjector projector(test_context());
    // a footprint is half a gap: 2 r / 64
    projector.add(scene.map({0, 0, wall + 16.0f * gap}, settings_with(64)));
    const TwinTests loose{3.0f, 3.0f, -1.0f, -1.0f};
    const glm::vec3 between(0.01f, 0.02f, 0.5f * (wall + hidden));
    for (const float forward : {-1.0f, 1.0f}) {
        const PixelView view =
            scene.view(looking(between, {0, 0, forward}, {0, 1, 0}, 1.0f, 1.0f), {32, 32});
        ASSERT_EQ(view.seen().pixels.size(), 32u * 32u);
        EXPECT_EQ(answer_from_maps(view, projector).holes, 32u * 32u);
        EXPECT_EQ(compare_with_twin(view, projector).answered, 0);
        EXPECT_GT(compare_with_twin(view, projector, loose).answered, 0);
    }
}

TEST(CubeProjector, HolesAreSolvedAtTheirOwnPixels)
{
    CubeScene scene(scenes::bumpy_sphere(12));
    CubeProjector projector(test_context());
    const CubeSettings settings = settings_with(32);
    const PixelView view =
        scene.view(looking({0, 0, 1.3f}, {0, 0, -1}, {0, 1, 0}, 0.4f, 0.4f), {48, 48});
    CubeAnswer none = answer_from_maps(view, projector);
    EXPECT_EQ(none.holes, view.seen().pixels.size());
    EXPECT_EQ(none.coverage(), 0.0);
    projector.add(scene.map({0.7f, 0.1f, 0.3f}, settings), 0.125f);
    CubeAnswer one = answer_from_maps(view, projector);
    EXPECT_GT(one.coverage(), 0.2);
    EXPECT_LT(one.coverage(), 0.9);
    const std::vector<float> told = one.occlusion;
    EXPECT_GT(std::ranges::count(one.share, 0.25f), 100);
    EXPECT_EQ(std::ranges::count(one.share, 0.25f) + std::ranges::count(one.share, 0.0f),
              std::ssize(one.share));
    EXPECT_EQ(std::ranges::count(one.share, 0.0f), static_cast<std::ptrdiff_t>(one.holes));
    solve_holes(one, view, scene.world(), settings);
    const std::vector<Occlusion> direct =
        answer(view, scene.occluders, scene.screen, settings.engine, settings.definition).values;
    int wrong = 0;
    for (std::size_t i = 0; i < direct.size(); ++i) {
        const float wanted = glm::mix(direct[i].occlusion, told[i], one.share[i]);
        wrong += std::abs(one.occlusion[i] - wanted) > 0.02f ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0);
}

// A camera that moves by half a pixel sees no pixel change by more than 2 of 255, but at edges,
// where it sees another place. Answers are a pattern that itself changes by less.
TEST(CubeProjector, ChangesContinuouslyWithTheEye)
{
    CubeScene room(scenes::room({-1, -0.8, -1.2}, {1, 0.8, 1.2}, 8));
    CubeProjector projector(test_context());
    for (const glm::vec3 centre :
         {glm::vec3(0.1f, 0.02f, -0.1f), glm::vec3(-0.1f, 0.1f, 0.1f), glm::vec3(0, -0.1f, 0.2f)}) {
        const CubeSight sight = look_around(test_context(), room.mesh, room.drawn, centre, 128);
        projector.add(cube_map_of(sight, pattern_at(sight, false)));
    }
    const View view = looking({-0.1f, 0.05f, 0.2f}, {0.3f, 0, -1}, {0, 1, 0}, 0.4f, 0.3f);
    View moved = view;
    // half a pixel at the distance of the nearest wall
    moved.eye += 0.5f * 0.8f / 320.0f * 0.2f * view.right;
    std::vector<CubeAnswer> answers;
    std::vector<std::vector<glm::vec4>> surfaces;
    for (const View& from : {view, moved}) {
        const PixelView pixels = room.view(from, {320, 240});
        answers.push_back(answer_from_maps(pixels, projector));
        surfaces.push_back(pixels.g_buffer().read_surface());
        ASSERT_EQ(answers.back().holes, 0u);
    }
    int changed = 0, same_wall = 0;
    for (std::size_t i = 0; i < answers[0].occlusion.size(); ++i) {
        const bool is_edge = glm::dot(glm::vec3(surfaces[0][i]), glm::vec3(surfaces[1][i])) < 0.99f;
        same_wall += is_edge ? 0 : 1;
        changed +=
            !is_edge && std::abs(answers[0].occlusion[i] - answers[1].occlusion[i]) > 2.0f / 255.0f
                ? 1
                : 0;
    }
    EXPECT_GT(same_wall, 70'000);
    EXPECT_EQ(changed, 0);
}

// Which maps are used changes with the eye; what they weigh does not jump.
TEST(CubeProjector, NearestMapsFadeBeforeTheyGo)
{
    const std::vector<glm::vec3> centres = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}};
    const std::vector<float> weights(4, 1.0f);
    const auto at = [&](float x) { return nearest_maps(centres, weights, {x, 0, 0}, 2); };
    ASSERT_EQ(at(0.4f).size(), 2u);
    EXPECT_EQ(at(0.4f)[0].index, 0u);
    EXPECT_EQ(at(0.4f)[0].weight, 1.0f);
    EXPECT_EQ(at(1.9f)[0].index, 2u);  // equal ones by index
    EXPECT_EQ(at(1.9f)[1].index, 3u);
    std::vector<float> before(4, 0.0f);
    float largest = 0.0f;
    for (int step = 0; step <= 2000; ++step) {
        std::vector<float> now(4, 0.0f);
        for (const ProjectedMap& map : at(0.001f * static_cast<float>(step)))
            now[map.index] = map.weight;
        for (std::size_t i = 0; step > 0 && i < 4; ++i)
            largest = std::max(largest, std::abs(now[i] - before[i]));
        before = now;
    }
    EXPECT_LT(largest, 0.02f);
    EXPECT_EQ(nearest_maps(centres, std::vector<float>{0, 1, 1, 1}, {0, 0, 0}, 4).size(), 3u);
}

}  // namespace
}  // namespace surfelao
