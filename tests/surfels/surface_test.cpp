#include "surfels/surface.h"

#include "scenes.h"
#include "surfels/errors.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr glm::vec3 kUp{0, 0, 1}, kDown{0, 0, -1};

Scene cube(int cells = 1)
{
    return scenes::box({0, 0, 0}, {1, 1, 1}, cells);
}

/// Two triangles in z = 0 that face up: 0 1 2 and 0 2 3.
Scene square()
{
    return scenes::grid(1, 1, [](double s, double t) { return glm::dvec3(s, t, 0); });
}

/// Quads of two triangles a b c, a c d, cut along the other diagonal.
Scene cut_otherwise(Scene scene)
{
    for (std::size_t t = 0; t < scene.triangles.size(); t += 2) {
        const glm::uvec3 abc = scene.triangles[t], acd = scene.triangles[t + 1];
        scene.triangles[t] = {abc.x, abc.y, acd.z};
        scene.triangles[t + 1] = {abc.y, abc.z, acd.z};
    }
    return scene;
}

glm::vec3 face_normal(const Geometry& geometry, std::size_t triangle)
{
    const glm::uvec3 t = geometry.triangles[triangle];
    return glm::normalize(glm::cross(geometry.positions[t.y] - geometry.positions[t.x],
                                     geometry.positions[t.z] - geometry.positions[t.x]));
}

glm::vec3 corner_normal(const Mesh& mesh, std::size_t triangle, int corner)
{
    return mesh.surface.normals[mesh.surface.corners(mesh.geometry)[triangle][corner]];
}

/// The largest distance of a corner's normal from that of its face.
float farthest_from_faces(const Mesh& mesh)
{
    float farthest = 0.0f;
    for (std::size_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner)
            farthest = std::max(farthest, glm::distance(corner_normal(mesh, t, corner),
                                                        face_normal(mesh.geometry, t)));
    }
    return farthest;
}

// ---- corner normals

TEST(CornerNormals, ACubeHasAWedgeForEachSideOrOneForEachVertexAsTheCreaseSays)
{
    const Mesh sharp = make_mesh(cube());
    EXPECT_EQ(sharp.surface.normals.size(), 24u);
    EXPECT_EQ(sharp.surface.vertex_count(), 8u);
    EXPECT_LT(farthest_from_faces(sharp), 1e-6f);
    for (std::size_t t = 0; t < 12; ++t) {
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_EQ(sharp.surface.vertex_of(sharp.surface.corners(sharp.geometry)[t][corner]),
                      sharp.geometry.triangles[t][corner]);
    }
    const Mesh round = make_mesh(cube(), {.crease = 180.0f});
    ASSERT_EQ(round.surface.normals.size(), 8u);
    for (std::size_t v = 0; v < 8; ++v)
        EXPECT_LT(
            glm::distance(round.surface.normals[v], glm::normalize(round.geometry.positions[v])),
            1e-6f);
}

// Weights by area or by count would favour the side on which two triangles meet. Up to 180 degrees
// all is smooth at once; at 100 it turns out to be when each pair is looked at.
TEST(CornerNormals, DoNotDependOnHowQuadsAreCut)
{
    for (const float crease : {180.0f, 100.0f}) {
        const Mesh one = make_mesh(cube(2), {.crease = crease});
        const Mesh other = make_mesh(cut_otherwise(cube(2)), {.crease = crease});
        ASSERT_EQ(one.surface.normals.size(), one.scene.positions.size());
        ASSERT_EQ(one.surface.normals.size(), other.surface.normals.size());
        for (std::size_t v = 0; v < one.surface.normals.size(); ++v)
            EXPECT_LT(glm::distance(one.surface.normals[v], other.surface.normals[v]), 1e-6f) << v;
    }
}

TEST(CornerNormals, FlatAreThoseOfTheFacesWhateverTheFileSays)
{
    Scene scene = scenes::sphere({0, 0, 0}, 1.0, 2);
    for (const glm::dvec3 p : scene.positions)
        scene.normals.values.emplace_back(p);
    const Mesh mesh = make_mesh(scene, {.source = NormalSource::flat});
    EXPECT_LT(farthest_from_faces(mesh), 1e-6f);
    EXPECT_EQ(mesh.surface.corners_from_file, 0u);
}

// Of like and unlike angles on both sides: the mean lies in the middle or beside it.
TEST(CornerNormals, FacesAreSmoothTogetherUpToTheCreaseExactly)
{
    for (const double width : {1.0, 0.1}) {
        for (const double bend_deg : {39.9, 40.1}) {
            const double bend = bend_deg / 180.0 * std::numbers::pi;
            Scene scene;
            scene.positions = {{0, 0, 0},
                               {0, 1, 0},
                               {-1, 0.5, 0},
                               {width * std::cos(bend), 0.5, width * std::sin(bend)}};
            scene.triangles = {{0, 1, 2}, {1, 0, 3}};
            const Surface surface = make_surface(scene, make_geometry(scene), {.crease = 40.0f});
            EXPECT_EQ(surface.normals.size(), bend_deg < 40.0 ? 4u : 6u) << bend_deg;
        }
    }
}

TEST(CornerNormals, DoubledFacesBackToBackKeepTheirOwnSides)
{
    const Scene hill =
        scenes::height_field(8, [](double x, double y) { return 0.3 * x * (1 - x) * y * (1 - y); });
    Scene shared = hill;
    for (const glm::uvec3 t : hill.triangles)
        shared.triangles.emplace_back(t.x, t.z, t.y);
    shared.parts[0].triangle_count *= 2;
    for (const Scene& scene : {shared, hill + scenes::flipped(hill)})
        EXPECT_LT(farthest_from_faces(make_mesh(scene)), 0.1f);
}

// What is told apart at one place is bounded: sums over all pairs of faces would not end.
TEST(CornerNormals, AHubOfManyBentFacesHasFewWedges)
{
    constexpr std::uint32_t kCount = 50'000;
    constexpr std::size_t kMostExtra = 65;  // wedges beside the vertex's own
    std::mt19937 random(1);
    const auto step = [&] { return random() / 2147483648.0 - 1.0; };
    Scene scene;
    scene.positions.push_back({0, 0, 0});
    for (std::uint32_t i = 0; i < kCount; ++i) {
        for (int corner = 0; corner < 2; ++corner) {
            const double x = step(), y = step(), z = step();
            scene.positions.emplace_back(x, y, z);
        }
        scene.triangles.emplace_back(0, 1 + 2 * i, 2 + 2 * i);
    }
    const Geometry geometry = make_geometry(scene);
    for (const NormalSource source : {NormalSource::smooth, NormalSource::flat}) {
        const Surface surface = make_surface(scene, geometry, {source, 20.0f});
        EXPECT_LE(surface.extra_vertices.size(), kMostExtra);
        for (const glm::vec3 normal : surface.normals)
            ASSERT_NEAR(glm::length(normal), 1.0f, 1e-5f);
    }
}

TEST(CornerNormals, CreasesOutOfRangeAreRefused)
{
    for (const float crease : {-1.0f, 181.0f, kNan})
        EXPECT_THROW(check_normals({.crease = crease}), SettingsError);
}

// ---- the file's

TEST(FileNormals, AreTakenAtAnyLengthPerVertexAndPerCorner)
{
    const glm::vec3 tilted[] = {{0.1f, 0, 1}, {0, 0.2f, 2}, {-3, 0, 30}, {0, -0.4f, 4}};
    Scene scene = square();
    scene.normals.values.assign(std::begin(tilted), std::end(tilted));
    const Mesh by_vertex = make_mesh(scene);
    EXPECT_EQ(by_vertex.surface.corners_from_file, 6u);
    for (int v = 0; v < 4; ++v)
        EXPECT_LT(glm::distance(by_vertex.surface.normals[static_cast<std::size_t>(v)],
                                glm::normalize(tilted[v])),
                  1e-6f);

    scene.normals.corners = {{3, 2, 1}, {0, CornerNormals::kNone, 0}};
    const Mesh by_corner = make_mesh(scene);
    EXPECT_EQ(by_corner.surface.corners_from_file, 5u);
    EXPECT_EQ(by_corner.surface.replaced_corners, 0u);
    for (int corner = 0; corner < 3; ++corner)
        EXPECT_LT(
            glm::distance(corner_normal(by_corner, 0, corner), glm::normalize(tilted[3 - corner])),
            1e-6f);
    EXPECT_LT(glm::distance(corner_normal(by_corner, 1, 1), kUp), 1e-6f);
}

TEST(FileNormals, ThatCannotBeAreReplacedAndCounted)
{
    Scene scene = square();  // vertices 0 and 3 have two corners each
    for (const glm::vec3 odd :
         {glm::vec3(kNan, 0, 1), glm::vec3(0, kInfinite, 0), glm::vec3(0.5f, 0, -1)}) {
        scene.normals.values = {kUp, kUp, kUp, kUp};
        scene.normals.values[scene.triangles[0].y] = odd;
        const Mesh mesh = make_mesh(scene);
        EXPECT_EQ(mesh.surface.corners_from_file, 5u);
        EXPECT_EQ(mesh.surface.replaced_corners, 1u);
        EXPECT_LT(farthest_from_faces(mesh), 1e-6f);
    }
    scene.normals.values[scene.triangles[0].y] = glm::vec3(0.0f);  // the file gives none
    const Mesh none = make_mesh(scene);
    EXPECT_EQ(none.surface.replaced_corners, 0u);
    EXPECT_LT(farthest_from_faces(none), 1e-6f);
}

TEST(FileNormals, OnTheOtherSideAreKeptWhereTheFileIsBelieved)
{
    Scene scene = square();
    scene.normals.values.assign(4, kDown);
    scene.normals.values[scene.triangles[0].y] = glm::vec3(kNan);
    scene.normals.values[scene.triangles[1].z] = glm::vec3(kInfinite);
    const Mesh mesh = make_mesh(scene, {.source = NormalSource::file});
    EXPECT_EQ(mesh.surface.corners_from_file, 4u);
    EXPECT_EQ(mesh.surface.replaced_corners, 2u);
    EXPECT_LT(glm::distance(corner_normal(mesh, 0, 0), kDown), 1e-6f);
}

TEST(FileNormals, OfCornersAreCountedInTheSceneWhereTrianglesAreDropped)
{
    Scene scene = square();
    scene.triangles.insert(scene.triangles.begin(), glm::uvec3(0, 1, 1));
    scene.parts[0].triangle_count = 3;
    const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, 0, 1));
    scene.normals.values = {kUp, tilted};
    scene.normals.corners = {glm::uvec3(0), glm::uvec3(0), glm::uvec3(1)};
    const Mesh mesh = make_mesh(scene);
    EXPECT_EQ(mesh.geometry.dropped_triangles, 1u);
    EXPECT_EQ(mesh.geometry.scene_triangle(0), 1u);
    EXPECT_EQ(mesh.geometry.scene_triangle(1), 2u);
    for (int corner = 0; corner < 3; ++corner) {
        EXPECT_LT(glm::distance(corner_normal(mesh, 0, corner), kUp), 1e-6f);
        EXPECT_LT(glm::distance(corner_normal(mesh, 1, corner), tilted), 1e-6f);
    }
    EXPECT_EQ(make_geometry(square()).scene_triangle(1), 1u);
}

// ---- receivers

TEST(Offsets, FollowTheTriangleBetweenTheirLimits)
{
    Scene scene = square();
    const auto offset_of = [&](double length, double width, const Offset& offset = {}) {
        const Scene own = scenes::triangle({0, 0, 0}, {length, 0, 0}, {0, width, 0});
        return offset_at(make_geometry(own + scene), 0, offset);
    };
    const float diagonal = std::sqrt(2.0f);
    EXPECT_EQ(offset_of(0.1, 0.1), kMostOffset);
    EXPECT_NEAR(offset_of(0.1, 1e-3), kOffsetShare * 1e-2f / diagonal, 1e-8f);
    EXPECT_EQ(offset_of(1e-5, 1e-5), kLeastOffset);
    for (const double size : {0.1, 1e-5})
        EXPECT_EQ(offset_of(size, size, 0.02f), 0.02f);
}

TEST(Receivers, StandOffTheFaceOnTheSideOfTheShadingNormal)
{
    Scene scene = square();
    for (const float side : {1.0f, -1.0f}) {
        const glm::vec3 tilted = glm::normalize(glm::vec3(0.6f, 0, side));
        scene.normals.values.assign(4, tilted);
        const Mesh mesh = make_mesh(scene, {.source = NormalSource::file});
        const SurfacePoint middle{1, {0.25f, 0.25f}};
        const Receiver found =
            receivers_at(mesh.geometry, mesh.surface, {&middle, 1}, 1e-3f).front();
        const glm::uvec3 t = mesh.geometry.triangles[1];
        const glm::vec3 below = 0.5f * mesh.geometry.positions[t.x] +
                                0.25f * mesh.geometry.positions[t.y] +
                                0.25f * mesh.geometry.positions[t.z];
        EXPECT_LT(glm::distance(found.position, below + glm::vec3(0, 0, side * 1e-3f)), 1e-7f);
        EXPECT_LT(glm::distance(found.normal, tilted), 1e-6f);
        EXPECT_EQ(found.offset, 1e-3f);
    }
}

// Five centimetres are 2e-5 of the scene.
TEST(Receivers, BetweenBoardsOnATerrainStayBetweenThem)
{
    const auto board = [](double z) {
        return scenes::grid(1, 1,
                            [z](double s, double t) { return glm::dvec3(2 * s, 0.3 * t, z); });
    };
    const Scene scene = board(10.0) + board(10.05) +
                        scenes::sheet({-1000, -1000, 0}, {2000, 0, 0}, {0, 2000, 0}, 8);
    const Mesh mesh = make_mesh(scene);
    const SurfacePoint points[] = {{0, {0.3f, 0.3f}}, {1, {0.3f, 0.3f}}};
    std::vector<Receiver> receivers = receivers_at(mesh.geometry, mesh.surface, points);
    const std::vector<Receiver> of_wedges = receivers_at_wedges(mesh.geometry, mesh.surface);
    receivers.insert(receivers.end(), of_wedges.begin(), of_wedges.begin() + 4);
    for (const Receiver& receiver : receivers) {
        const double z = mesh.geometry.frame.centre.z +
                         mesh.geometry.frame.diagonal * double(receiver.position.z);
        EXPECT_GT(z, 10.001);
        EXPECT_LT(z, 10.045);
    }
}

TEST(ReceiversAtWedges, StandExactlyAboveSmoothVertices)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1.0, 6));
    const std::vector<Receiver> receivers = receivers_at_wedges(mesh.geometry, mesh.surface);
    ASSERT_EQ(receivers.size(), mesh.geometry.positions.size());
    for (std::size_t v = 0; v < receivers.size(); ++v) {
        EXPECT_GE(receivers[v].offset, kLeastOffset);
        EXPECT_EQ(receivers[v].position,
                  mesh.geometry.positions[v] + receivers[v].offset * mesh.surface.normals[v]);
    }
}

TEST(ReceiversAtWedges, InACornerStandInsideTheirOwnFace)
{
    const Scene shared = scenes::wall_and_floor(1.0, 4);
    const Scene split = scenes::sheet({0, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, 4) +
                        scenes::sheet({0, -0.5, 0}, {0, 1, 0}, {0, 0, 1}, 4);
    for (const Scene& scene : {shared, split}) {
        const Mesh mesh = make_mesh(scene);
        const glm::vec3 corner(-mesh.geometry.frame.centre / mesh.geometry.frame.diagonal);
        const float half = static_cast<float>(0.5 / mesh.geometry.frame.diagonal);
        int at_foot = 0;
        for (const Receiver& receiver : receivers_at_wedges(mesh.geometry, mesh.surface)) {
            const glm::vec3 place = receiver.position - corner;
            const float above = receiver.normal.z > 0.5f ? place.z : place.x;
            const float inside = receiver.normal.z > 0.5f ? place.x : place.z;
            EXPECT_NEAR(above, receiver.offset, 1e-7f);
            EXPECT_GT(inside, 1.5f * receiver.offset);
            EXPECT_LT(std::abs(place.y), half);
            at_foot += inside < 10.0f * receiver.offset;
        }
        EXPECT_EQ(at_foot, 2 * (scene.positions.size() == shared.positions.size() ? 9 : 5));
    }
}

// Not where the little way into the triangle has taken them.
TEST(ReceiversAtWedges, FaceAlongTheWedgesNormalsAtBordersToo)
{
    const Mesh mesh =
        make_mesh(scenes::height_field(4, [](double x, double) { return 0.3 * x * x; }));
    const std::vector<Receiver> receivers = receivers_at_wedges(mesh.geometry, mesh.surface);
    ASSERT_EQ(receivers.size(), mesh.surface.normals.size());
    for (std::size_t w = 0; w < receivers.size(); ++w)
        EXPECT_EQ(receivers[w].normal, mesh.surface.normals[w]);
}

TEST(AnglesOfWedges, AreThoseOfTheSurfaceAroundTheVertex)
{
    constexpr float kQuarter = 0.5f * std::numbers::pi_v<float>;
    for (const Scene& scene : {cube(), cut_otherwise(cube())}) {
        const Mesh sharp = make_mesh(scene), round = make_mesh(scene, {.crease = 180.0f});
        for (const float angle : angles_of_wedges(sharp.geometry, sharp.surface))
            EXPECT_NEAR(angle, kQuarter, 1e-5f);
        for (const float angle : angles_of_wedges(round.geometry, round.surface))
            EXPECT_NEAR(angle, 3.0f * kQuarter, 1e-5f);
    }
}

// ---- meshes of free vertices

TEST(MakeMesh, SplitsFreeVerticesAtCreases)
{
    Scene scene = cube();
    EXPECT_EQ(make_mesh(scene).scene.positions.size(), 8u) << "those of a file stay";
    scene.free_vertices = true;
    const Mesh mesh = make_mesh(scene);
    ASSERT_EQ(mesh.scene.positions.size(), 24u);
    for (std::size_t v = 0; v < 8; ++v)
        EXPECT_EQ(mesh.scene.positions[v], scene.positions[v]);
    for (std::size_t t = 0; t < 12; ++t) {
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_EQ(mesh.scene.positions[mesh.scene.triangles[t][corner]],
                      scene.positions[scene.triangles[t][corner]]);
    }
    EXPECT_EQ(mesh.surface.normals.size(), 24u);
    EXPECT_EQ(mesh.scene.parts[0].vertex_count, 24u);
    EXPECT_EQ(mesh.geometry.welded[23], make_geometry(mesh.scene).welded[23]);
    EXPECT_LT(mesh.geometry.welded[23], 8u);
}

// Three faces bent by 31 degrees each: the middle one is smooth with both others, which are not
// with each other. So their corners at the hub have three normals, of which two are nearly alike.
TEST(MakeMesh, KeepsOneVertexForWedgesThatAreNearlyAlike)
{
    glm::dvec3 n[3];
    for (int face = 0; face < 3; ++face) {
        const double angle = (face - 1) * 35.0 / 180.0 * std::numbers::pi;
        n[face] = glm::normalize(glm::dvec3(std::sin(angle), 0.5, std::cos(angle)));
    }
    const glm::dvec3 left = glm::normalize(glm::cross(n[0], n[1]));
    const glm::dvec3 right = glm::normalize(glm::cross(n[1], n[2]));
    Scene scene;
    scene.positions = {{0, 0, 0},
                       3.0 * left + glm::cross(left, n[0]),
                       left,
                       right,
                       3.0 * right + glm::cross(n[2], right)};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    scene.parts.resize(1);
    scene.parts[0].vertex_count = 5;
    scene.parts[0].triangle_count = 3;
    scene.free_vertices = true;
    const Geometry geometry = make_geometry(scene);
    EXPECT_EQ(make_surface(scene, geometry).normals.size(), 7u);
    const Scene split = make_mesh(scene).scene;
    ASSERT_EQ(split.positions.size(), 6u);
    EXPECT_EQ(split.positions[5], scene.positions[0]);
    EXPECT_EQ(split.triangles[0].x, split.triangles[1].x);
    EXPECT_NE(split.triangles[0].x, split.triangles[2].x);
}

TEST(MakeMesh, LeavesSmoothFreeVerticesWhole)
{
    Scene scene = scenes::sphere({0, 0, 0}, 1.0, 6);
    scene.free_vertices = true;
    EXPECT_EQ(make_mesh(scene).scene.positions, scene.positions);
}

TEST(MakeMesh, RefusesPointsWithoutFaces)
{
    Scene points;
    points.positions = {{0, 0, 0}};
    EXPECT_THROW(static_cast<void>(make_mesh(points)), InputError);
}

// A far shell that is left out changes neither the frame nor any place or normal.
TEST(MakeMesh, DoesNotSeeWhatIsLeftOut)
{
    const Scene body = scenes::sphere({0, 0, 0}, 1.0, 6);
    const Scene whole = body + scenes::sphere({0, 0, 0}, 1e9, 4);
    GeometryScope scope;
    scope.left_out.resize(whole.triangles.size());
    std::fill(scope.left_out.begin() + static_cast<std::ptrdiff_t>(body.triangles.size()),
              scope.left_out.end(), true);
    const Mesh alone = make_mesh(body), among = make_mesh(whole, {}, scope);
    EXPECT_EQ(among.geometry.frame.diagonal, alone.geometry.frame.diagonal);
    EXPECT_EQ(among.geometry.triangles, alone.geometry.triangles);
    EXPECT_EQ(among.geometry.dropped_triangles, 0u);
    const std::size_t vertices = body.positions.size();
    for (std::size_t v = 0; v < among.geometry.positions.size(); ++v) {
        EXPECT_LE(glm::length(among.geometry.positions[v]), 2e6f);
        EXPECT_EQ(among.surface.normals[v], v < vertices ? alone.surface.normals[v] : glm::vec3(0));
    }
}

// Half of a sphere keeps the normals that it has among the whole, and asks nothing elsewhere.
TEST(KeepTriangles, KeepsNormalsOfTheWholeSurface)
{
    const Mesh whole = make_mesh(scenes::sphere({0, 0, 0}, 1.0, 6));
    Mesh half = whole;
    const auto wanted = [](std::size_t triangle) { return triangle % 2 == 1 && triangle < 100; };
    keep_triangles(half, wanted);
    ASSERT_EQ(half.geometry.triangles.size(), 50u);
    std::vector<bool> in_use(whole.surface.normals.size());
    for (std::size_t t = 0; t < 50; ++t) {
        EXPECT_EQ(half.geometry.scene_triangle(t), 2 * t + 1);
        EXPECT_EQ(half.geometry.triangles[t], whole.geometry.triangles[2 * t + 1]);
        EXPECT_EQ(half.surface.corners(half.geometry)[t],
                  whole.surface.corners(whole.geometry)[2 * t + 1]);
        for (int corner = 0; corner < 3; ++corner)
            in_use[half.surface.corners(half.geometry)[t][corner]] = true;
    }
    for (std::size_t wedge = 0; wedge < in_use.size(); ++wedge)
        EXPECT_EQ(half.surface.normals[wedge],
                  in_use[wedge] ? whole.surface.normals[wedge] : glm::vec3(0));
}

}  // namespace
}  // namespace surfelao
