#include "surfels/topology.h"

#include "scenes.h"

#include <gtest/gtest.h>

// OpenMesh: a second opinion, from a library whose whole business is connectivity.
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace surfelao {
namespace {

/// A box of the given size about a centre, outward, with 8 vertices.
Scene box(glm::dvec3 centre = glm::dvec3(0.0), double size = 1.0)
{
    Scene scene;
    for (int corner = 0; corner < 8; ++corner)
        scene.positions.push_back(centre +
                                  size * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1));
    scene.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return scene;
}

void turn_inside_out(Scene& scene)
{
    for (glm::uvec3& t : scene.triangles)
        std::swap(t.y, t.z);
}

void add(Scene& scene, const Scene& other)
{
    const std::uint32_t first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), other.positions.begin(), other.positions.end());
    for (const glm::uvec3 t : other.triangles)
        scene.triangles.push_back(t + first);
}

/// Every triangle with corners of its own, as in STL or a flat-shaded model.
Scene exploded(const Scene& scene)
{
    Scene out;
    for (const glm::uvec3 t : scene.triangles) {
        const std::uint32_t first = static_cast<std::uint32_t>(out.positions.size());
        for (int corner = 0; corner < 3; ++corner)
            out.positions.push_back(scene.positions[t[corner]]);
        out.triangles.push_back({first, first + 1, first + 2});
    }
    return out;
}

/// (n + 1)^2 vertices in z = 0.
Scene grid(std::uint32_t n)
{
    Scene scene;
    for (std::uint32_t y = 0; y <= n; ++y) {
        for (std::uint32_t x = 0; x <= n; ++x)
            scene.positions.push_back({x, y, 0});
    }
    for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x;
            scene.triangles.push_back({a, a + 1, a + n + 2});
            scene.triangles.push_back({a, a + n + 2, a + n + 1});
        }
    }
    return scene;
}

Topology topology_of(const Scene& scene)
{
    return analyse_topology(make_geometry(scene));
}

std::ptrdiff_t count(const Topology& topology, OccluderSide side)
{
    return std::ranges::count(topology.sides, side);
}

TEST(Topology, AClosedBoxFacesOutward)
{
    const Topology topology = topology_of(box());
    EXPECT_EQ(topology.component_count, 1u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(topology.boundary_edge_count, 0u);
    EXPECT_EQ(topology.nonmanifold_edge_count, 0u);
    EXPECT_EQ(topology.misoriented_edge_count, 0u);
    EXPECT_EQ(topology.duplicate_triangle_count, 0u);
    EXPECT_EQ(count(topology, OccluderSide::back), 8);
}

TEST(Topology, ABoxTurnedInsideOutFacesInwardWhereverItStands)
{
    for (double offset : {0.0, -3.0, 1e6}) {
        Scene scene = box(glm::dvec3(offset));
        turn_inside_out(scene);
        EXPECT_EQ(count(topology_of(scene), OccluderSide::front), 8) << "offset " << offset;
    }
}

TEST(Topology, SeamsDoNotOpenASurface)
{
    const Topology topology = topology_of(exploded(box()));
    EXPECT_EQ(topology.component_count, 1u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(count(topology, OccluderSide::back), 36);
}

TEST(Topology, AMissingTriangleOpensItsBodyOnly)
{
    Scene scene = box();
    scene.triangles.pop_back();
    add(scene, box({5, 0, 0}));
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.component_count, 2u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(topology.boundary_edge_count, 3u);
    EXPECT_TRUE(std::all_of(topology.sides.begin(), topology.sides.begin() + 8,
                            [](OccluderSide side) { return side == OccluderSide::both; }));
    EXPECT_TRUE(std::all_of(topology.sides.begin() + 8, topology.sides.end(),
                            [](OccluderSide side) { return side == OccluderSide::back; }));
}

TEST(Topology, OneTurnedTriangleMakesItsBodyTwoSided)
{
    Scene scene = box();
    std::swap(scene.triangles[0].x, scene.triangles[0].y);
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.misoriented_edge_count, 3u);
    EXPECT_EQ(topology.closed_component_count, 0u);
    EXPECT_EQ(count(topology, OccluderSide::both), 8);
}

// A cavity: the inner shell faces the hollow, which is inward as seen from its own volume.
TEST(Topology, TheShellOfACavityHasASideOfItsOwn)
{
    Scene scene = box({0, 0, 0}, 3.0);
    Scene cavity = box({1, 1, 1}, 1.0);
    turn_inside_out(cavity);
    add(scene, cavity);
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.closed_component_count, 2u);
    EXPECT_EQ(count(topology, OccluderSide::back), 8);
    EXPECT_EQ(count(topology, OccluderSide::front), 8);
}

// Two boxes share the corner (1, 1, 1): one component, two bodies.
TEST(Topology, BodiesThatTouchInAPointKeepTheirSides)
{
    Scene scene = box();
    Scene other = box({1, 1, 1});
    turn_inside_out(other);
    add(scene, other);
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.component_count, 1u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(count(topology, OccluderSide::back), 7);
    EXPECT_EQ(count(topology, OccluderSide::front), 7);
    EXPECT_EQ(count(topology, OccluderSide::both), 2);
}

TEST(Topology, FacesGivenTwiceChangeNothingButTheirCount)
{
    Scene scene = box();
    add(scene, box());  // other vertices at the same places
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.duplicate_triangle_count, 12u);
    EXPECT_EQ(topology.nonmanifold_edge_count, 0u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(count(topology, OccluderSide::back), 16);
}

TEST(Topology, FacesGivenBothWaysAreASheetAndEncloseNothing)
{
    Scene scene = grid(2);
    Scene reverse = grid(2);
    turn_inside_out(reverse);
    add(scene, reverse);
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.duplicate_triangle_count, 8u);
    EXPECT_EQ(topology.component_count, 1u);
    EXPECT_EQ(topology.closed_component_count, 0u);
    EXPECT_EQ(count(topology, OccluderSide::both), 18);
}

// A fin on a closed body: a triangle given both ways on one of the body's edges.
TEST(Topology, AFinDoesNotOpenTheBodyItStandsOn)
{
    Scene scene = box();
    scene.positions.push_back({0.5, -1, 2});
    scene.triangles.push_back({0, 1, 8});
    scene.triangles.push_back({1, 0, 8});
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.nonmanifold_edge_count, 0u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(count(topology, OccluderSide::back), 8);
    EXPECT_EQ(topology.sides[8], OccluderSide::both);
}

// Two triangles over four points of a plane, front and back cut along different diagonals: closed
// and oriented, but without volume.
TEST(Topology, AFlatBodyIsTwoSided)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(count(topology, OccluderSide::both), 4);
}

// Two boxes share the edge from (1, 1, 0) to (1, 1, 1): four faces, but still the skin of a solid.
TEST(Topology, BodiesThatTouchAlongAnEdgeStayClosed)
{
    Scene scene = box();
    add(scene, box({1, 1, 0}));
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.nonmanifold_edge_count, 1u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(count(topology, OccluderSide::back), 16);
}

// Three sheets meet in an edge: nothing is inside.
TEST(Topology, AThirdFaceAtAnEdgeOpensTheBody)
{
    Scene scene = box();
    scene.positions.push_back({0.5, -1, 2});
    scene.triangles.push_back({0, 1, 8});
    EXPECT_EQ(topology_of(scene).closed_component_count, 0u);
    EXPECT_EQ(count(topology_of(scene), OccluderSide::both), 9);
}

// Given three times, once the other way round: the majority is the surface.
TEST(Topology, OfRepeatedFacesTheMajorityCounts)
{
    Scene scene = box();
    scene.triangles.push_back({3, 2, 0});
    scene.triangles.push_back(scene.triangles[0]);
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.duplicate_triangle_count, 2u);
    EXPECT_EQ(topology.closed_component_count, 1u);
    EXPECT_EQ(count(topology, OccluderSide::back), 8);
}

TEST(Topology, ManyFacesOnOneEdgeAreOneNonManifoldEdge)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 1000.0;
        scene.positions.push_back({std::cos(angle), std::sin(angle), 0.5});
        scene.triangles.push_back({0, 1, 2 + i});
    }
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.nonmanifold_edge_count, 1u);
    EXPECT_EQ(topology.boundary_edge_count, 2000u);
    EXPECT_EQ(topology.component_count, 1u);
}

TEST(Topology, UnusedVerticesAreNoComponents)
{
    Scene scene = box();
    scene.positions.push_back({9, 9, 9});
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.component_count, 1u);
    ASSERT_EQ(topology.sides.size(), 9u);
    EXPECT_EQ(topology.sides[8], OccluderSide::both);
}

TEST(Topology, NothingAtAllIsAnAnswerToo)
{
    Scene scene;
    scene.positions.assign(3, {7, 7, 7});
    scene.triangles = {{0, 1, 2}};
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.component_count, 0u);
    EXPECT_EQ(topology.sides.size(), 3u);
}

// Manifold meshes with random holes, triangles in random order.
TEST(Topology, AgreesWithOpenMeshOnBoundaries)
{
    omerr().disable();
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        Scene scene = grid(12);
        std::shuffle(scene.triangles.begin(), scene.triangles.end(), random);
        scene.triangles.resize(288 - static_cast<std::size_t>(round) * 3);
        const Geometry geometry = make_geometry(scene);

        OpenMesh::TriMesh_ArrayKernelT<> mesh;
        std::vector<OpenMesh::VertexHandle> vertices;
        for (const glm::vec3 p : geometry.positions)
            vertices.push_back(mesh.add_vertex({p.x, p.y, p.z}));
        std::uint64_t refused = 0;
        for (const glm::uvec3 t : geometry.triangles) {
            const auto face = mesh.add_face(vertices[t.x], vertices[t.y], vertices[t.z]);
            refused += face.is_valid() ? 0 : 1;
        }
        ASSERT_EQ(refused, 0u) << "round " << round;
        const auto boundary = std::count_if(mesh.edges_begin(), mesh.edges_end(),
                                            [&](auto edge) { return mesh.is_boundary(edge); });
        EXPECT_EQ(analyse_topology(geometry).boundary_edge_count,
                  static_cast<std::uint64_t>(boundary))
            << "round " << round;
    }
}

TEST(Topology, SlowAMillionLoneTrianglesAreAMillionComponents)
{
    Scene scene;
    for (std::uint32_t i = 0; i < 1'000'000; ++i) {
        const glm::dvec3 at(i % 1000 * 2, i / 1000 * 2, 0);
        for (const glm::dvec3 corner : {glm::dvec3(0, 0, 0), {1, 0, 0}, {0, 1, 0}})
            scene.positions.push_back(at + corner);
        scene.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.component_count, 1'000'000u);
    EXPECT_EQ(topology.boundary_edge_count, 3'000'000u);
}

// The hub of a disc of 10^6 triangles in random order: no step may walk around a vertex.
TEST(Topology, SlowAVertexOfEnormousValenceCostsNoMore)
{
    constexpr std::uint32_t kCount = 1'000'000;
    Scene scene;
    scene.positions.push_back({0, 0, 0});
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kCount;
        scene.positions.push_back({std::cos(angle), std::sin(angle), i % 2});
        scene.triangles.push_back({0, 1 + i, 1 + (i + 1) % kCount});
    }
    std::shuffle(scene.triangles.begin(), scene.triangles.end(), std::mt19937(1));
    const Topology topology = topology_of(scene);
    EXPECT_EQ(topology.boundary_edge_count, kCount);
    EXPECT_EQ(topology.component_count, 1u);
}

// What a scan has: a body with small holes still has a back.
TEST(Topology, SmallHolesAndTurnedPatchesLeaveABodyItsBack)
{
    const Scene whole = scenes::sphere({0, 0, 0}, 1.0, 8);  // 768 triangles of about 0.13 % each
    const auto sides_without = [&](std::size_t triangles, bool turned) {
        Scene scene = whole;
        if (turned)
            for (std::size_t i = 0; i < triangles; ++i)
                std::swap(scene.triangles[i].y, scene.triangles[i].z);
        else
            scene.triangles.erase(scene.triangles.begin(),
                                  scene.triangles.begin() + static_cast<std::ptrdiff_t>(triangles));
        return topology_of(scene).sides.back();
    };
    EXPECT_EQ(sides_without(8, false), OccluderSide::back);    // 1 %
    EXPECT_EQ(sides_without(128, false), OccluderSide::both);  // a sixth
    EXPECT_EQ(sides_without(4, true), OccluderSide::back);
    EXPECT_EQ(sides_without(128, true), OccluderSide::both);
}

// Two open ends whose vector areas cancel are holes all the same.
TEST(Topology, ATubeHasNoBack)
{
    const Scene box = scenes::box({0, 0, 0}, {1, 1, 1}, 4);  // two sides are the lowest triangles
    Scene tube = box;
    tube.triangles.erase(tube.triangles.begin(), tube.triangles.begin() + 64);
    EXPECT_EQ(topology_of(tube).sides.back(), OccluderSide::both);
    EXPECT_EQ(topology_of(box).sides.back(), OccluderSide::back);
}

}  // namespace
}  // namespace surfelao
