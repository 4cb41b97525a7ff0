#include "tests/engines/worlds.h"

#include "tests/scenes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace surfelao {
namespace {

using scenes::operator+;
using scenes::operator+=;

constexpr double kPi = std::numbers::pi;
constexpr glm::dvec3 kUp{0, 0, 1};

/// Points of a (0,2)-net miss an area by what the cells on its rim get wrong: about sqrt(n) cells
/// of 1/n, each off by a random part of itself, so n^-3/4 RMS. Five times that for single values.
const double kRaysNoise = 5.0 * std::pow(4096.0, -0.75);

/// In a closed place one ray in a million passes through an edge: the fast traversal's rounding.
constexpr double kLeak = 1e-6, kLeakAtOne = 1.5 / 4096;

/// A single receiver of masks: what rests on the raster and on clusters. The raster of exact
/// triangles is good to 0.005 (0.0014 RMS on a bunny); the others were measured on these worlds
/// and rounded up.
constexpr double kDraftMasks = 0.075, kGoodMasks = 0.025, kExactMasks = 0.006;

std::function<double(glm::dvec3)> always(double occlusion)
{
    return [occlusion](glm::dvec3) { return occlusion; };
}

/// The share of the hemisphere that a rectangle hides when it stands upright on the receiver's
/// plane, `distance` away, from the nearest point on it `width` to one side and `height` up
/// (Lambert).
double upright_quarter(double distance, double width, double height)
{
    const double slant = std::hypot(distance, height);
    return (std::atan2(width, distance) - distance / slant * std::atan2(width, slant)) /
           (2.0 * kPi);
}

/// The same for a square straight above at `height`, `half` by `half` from the point overhead.
double level_quarter(double height, double half)
{
    const double x = half / height, root = std::sqrt(1.0 + x * x);
    return 2.0 * x / root * std::atan(x / root) / (2.0 * kPi);
}

/// Far from the rest, so that a scene that is asked about outside it has a size.
Scene speck(glm::dvec3 place)
{
    return scenes::sheet(place, {0.01, 0, 0}, {0, 0.01, 0}, 1);
}

/// Disks of radius 1 round (0, 0, height), made of a square grid whose rings become circles.
Scene disk(double height)
{
    return scenes::moved(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 32), [=](glm::dvec3 p) {
        const double ring = std::max(std::abs(p.x), std::abs(p.y));
        const double length = std::sqrt(p.x * p.x + p.y * p.y);
        const double scale = length > 0.0 ? ring / length : 0.0;
        return glm::dvec3(p.x * scale, p.y * scale, height);
    });
}

using Worlds = std::vector<ExactWorld>;

// Facets stay below the tangent planes at their vertices; what clusters raise above them is the
// error of masks. Two grazing rays of 256 are forgiven: the offset is 1e-4, the facets' angles are
// not. Neighbouring disks dip under each other's horizon but for rounding.
void add_open_worlds(Worlds& worlds)
{
    worlds.push_back({"Plane",
                      scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 20),
                      {},
                      always(0.0),
                      {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}});
    const Scene sphere = scenes::sphere({0, 0, 0}, 1.0, 10);
    worlds.push_back({"ConvexSphere",
                      sphere,
                      {},
                      always(0.0),
                      {.rays = 2.0 / 256, .disks = 1e-3, .disks_best = 1e-3}});
    worlds.push_back(
        {"ConvexSphereMean", sphere, {}, always(0.0), {kNotAsked, 1e-3, 1e-3, 1e-3, 1e-3}, true});
    worlds.push_back({"Box",
                      scenes::box({0, 0, 0}, {1, 1, 1}, 1),
                      {},
                      always(0.0),
                      {2.0 / 256, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3}});
}

// Masks: cracks between clusters shrink with them; between exact rectangles and the clusters along
// a room's edges fewer are filled: 0.9949 in the room at best, 0.9994 in the sphere. Where one
// rectangle might stand for both sides of an edge, 24 cells (halves of three make no power of two)
// had 0.952, 0.981 and 0.992.
// Disks: inside a sphere each subtends its share of the sphere's area whatever the place, so the
// sum is 1 but for the nearest disks, where the kernel saturates (0.985 to 1). A room's vertices on
// edges have tilted normals; on its faces, away from the edges, its disks are round.
void add_closed_worlds(Worlds& worlds)
{
    worlds.push_back({"RoomMean",
                      scenes::room({0, 0, 0}, {1.0, 1.3, 0.8}, 12),
                      {},
                      always(1.0),
                      {kLeak, 0.05, 0.025, 5e-4, kNotAsked, kNotAsked, 0.006},
                      true});
    worlds.push_back({"RoomOf24CellsMean",
                      scenes::room({0, 0, 0}, {1, 1, 1}, 24),
                      {},
                      always(1.0),
                      {kLeak, 0.015, 0.001},
                      true});
    worlds.push_back({"RoomsCorners",
                      scenes::room({0, 0, 0}, {1, 1, 1}, 12),
                      {},
                      always(1.0),
                      {.rays = kLeakAtOne, .disks = 0.6}});
    std::vector<Place> floor, diagonal;
    for (const double cells : {1.0, 3.0, 12.0}) {
        floor.push_back({{cells / 24, 0.5, 0}, kUp});
        diagonal.push_back({{cells / 24, cells / 24, 0}, kUp});
    }
    const Scene room = scenes::room({0, 0, 0}, {1, 1, 1}, 24);
    worlds.push_back({"RoomsFloor",
                      room,
                      floor,
                      always(1.0),
                      {0.0, kDraftMasks, kGoodMasks, kExactMasks, 0.07, 0.07}});
    worlds.push_back({"RoomsFloorNearEdges",
                      room,
                      diagonal,
                      always(1.0),
                      {0.0, kDraftMasks, kGoodMasks, kExactMasks, 0.1, 0.1}});
    worlds.push_back({"SphereFromInsideMean",
                      scenes::flipped(scenes::sphere({0, 0, 0}, 1.0, 12)),
                      {},
                      always(1.0),
                      {kLeak, 0.05, 0.025, 5e-4, 0.03, 0.03, 0.006},
                      true});
    worlds.push_back({"SphereFromInside",
                      scenes::flipped(scenes::sphere({0, 0, 0}, 1.0, 24)),
                      {},
                      always(1.0),
                      {.rays = kLeakAtOne, .disks_best = 0.03}});
    worlds.push_back({"InsideABox",
                      scenes::box({0, 0, 0}, {1, 1, 1}, 1),
                      {{glm::dvec3(0.5), kUp}, {{0.01, 0.5, 0.999}, kUp}},
                      always(1.0),
                      {.rays = 0.0, .exact = 0.0}});
}

void add_walls(Worlds& worlds)
{
    // two cells from the foot; the wall's top is 50 times as far: 1/2 less 1e-4
    worlds.push_back({"FootOfAnEndlessWall",
                      scenes::wall_and_floor(200.0, 100),
                      {{{4.0, 0.0, 0.0}, kUp}},
                      always(0.5 * (1.0 - 1.0 / std::sqrt(1.0 + 50.0 * 50.0))),
                      {kRaysNoise, kDraftMasks, kGoodMasks, kExactMasks}});
    // three cells from the wall on its disks are small enough
    std::vector<Place> feet;
    for (const double cells : {3.0, 6.0, 20.0})
        feet.push_back({{cells / 64, 0, 0}, kUp});
    worlds.push_back({"FootOfAWall",
                      scenes::wall_and_floor(1.0, 64),
                      feet,
                      [](glm::dvec3 p) { return 2.0 * upright_quarter(p.x, 0.5, 1.0); },
                      {kRaysNoise, kDraftMasks, kGoodMasks, kExactMasks, 0.01, 0.01}});
    // floor and four walls, no lid; disks: 0.036 and 0.011 too little
    const auto wall = [](glm::dvec3 corner, glm::dvec3 along) {
        return scenes::sheet(corner, along, {0, 0, 1}, 32);
    };
    worlds.push_back({"SquarePit",
                      scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 32) +
                          wall({-1, -1, 0}, {0, 2, 0}) + wall({1, -1, 0}, {0, 2, 0}) +
                          wall({-1, -1, 0}, {2, 0, 0}) + wall({-1, 1, 0}, {2, 0, 0}),
                      {{{0, 0, 0}, kUp}},
                      [](glm::dvec3 p) { return 1.0 - 4.0 * level_quarter(1.0 - p.z, 1.0); },
                      {kRaysNoise, kDraftMasks, kGoodMasks, kExactMasks, 0.045, 0.015}});
}

// R^2 / (R^2 + d^2); k coincident sheets are one sheet. Rectangles miss a disk's rim and each
// other's: 0.034 at good is the worst here; disks of 4 to 32 cells at these heights have an RMS
// error of 0.02 at draft and 0.015 at good. The disk is a polygon of 128 corners: smaller by 4e-4.
void add_disks(Worlds& worlds)
{
    for (const double height : {0.2, 0.5, 1.0, 3.0}) {
        for (const int copies : {1, 5}) {
            Scene scene = speck({-0.1, -0.1, -0.5});
            for (int copy = 0; copy < copies; ++copy)
                scene += disk(height);
            worlds.push_back(
                {"FacingDisk" + std::to_string(static_cast<int>(10 * height)) +
                     (copies > 1 ? "InFiveSheets" : ""),
                 std::move(scene),
                 {{{0, 0, 0}, kUp}},
                 [height](glm::dvec3 p) { return 1.0 / (1.0 + std::pow(height - p.z, 2)); },
                 {kRaysNoise + 7e-4, kDraftMasks + 0.01, kGoodMasks + 0.01, kExactMasks + 0.01,
                  copies == 1 ? 0.03 : kNotAsked, copies == 1 ? 0.02 : kNotAsked}});
        }
    }
}

// (R/d)^2 max(0, n.w) for a sphere wholly above the horizon; the facets of 24 cells: 1e-3.
void add_spheres(Worlds& worlds)
{
    std::vector<Place> places;
    for (const glm::dvec3 place : {glm::dvec3(0, 0, -2.5), glm::dvec3(1.5, -1.0, -2.0),
                                   glm::dvec3(-2.5, 1.0, -2.5), glm::dvec3(0, 0, -5)})
        places.push_back({place, kUp});
    for (const double angle : {0.5, 1.0})
        places.push_back({3.0 * glm::dvec3(-std::sin(angle), 0, -std::cos(angle)), kUp});
    worlds.push_back({"SphereInView",
                      scenes::sphere({0, 0, 0}, 1.0, 24) + speck({-4, -4, -5}),
                      places,
                      [](glm::dvec3 p) { return -p.z / std::pow(glm::dot(p, p), 1.5); },
                      {kRaysNoise + 1e-3, kDraftMasks, kGoodMasks, kExactMasks, 0.01, 0.01}});
    worlds.push_back(
        {"SphereClose",
         scenes::sphere({0, 0, 0}, 1.0, 24),
         {{{0, 0, 1.5}, -kUp}, {{0, 0, 2.0}, -kUp}},
         [](glm::dvec3 p) { return 1.0 / glm::dot(p, p); },
         {kRaysNoise + 1e-3, kDraftMasks, kGoodMasks, kExactMasks + 1e-3, 0.01, 0.01}});
    // masks at good: 0.044 too little at distance 2
    for (const double distance : {1.5, 2.0, 5.0}) {
        const glm::dvec3 normal(std::sin(0.3), 0, -std::cos(0.3));
        worlds.push_back(
            {"TiltedBelowASphere" + std::to_string(static_cast<int>(10 * distance)),
             scenes::sphere({0, 0, 0}, 1.0, 24),
             {{{0, 0, distance}, normal}},
             [normal](glm::dvec3 p) {
                 return -glm::dot(p, normal) / std::pow(glm::dot(p, p), 1.5);
             },
             {kRaysNoise + 1e-3, kDraftMasks, 2 * kGoodMasks, kExactMasks + 1e-3, 0.01}});
    }
}

// A wide ceiling at height h: what lies within the limit D is a disk of radius sqrt(D^2 - h^2), so
// 1 - (h/D)^2; with the falloff the mean of (1 - (t/D)^2)^2 over it, t = h / cos: in c = (h/D)^2,
// integral over x = cos^2 from c to 1 of (1 - c/x)^2 dx = 1 - c^2 + 2 c log c.
void add_ceilings(Worlds& worlds)
{
    const Scene wide = scenes::sheet({-50, -50, 1}, {0, 100, 0}, {100, 0, 0}, 40);
    const Scene fine = scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 24) +
                       scenes::sheet({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 24);
    for (const float limit : {0.9f, 1.2f, 1.25f, 2.0f, 5.0f}) {
        for (const Falloff falloff : {Falloff::none, Falloff::smooth}) {
            const auto answer = [limit, falloff](glm::dvec3 p) {
                const double c = std::min(1.0, std::pow((1.0 - p.z) / limit, 2));
                return falloff == Falloff::none ? 1.0 - c : 1.0 - c * c + 2.0 * c * std::log(c);
            };
            const std::string name =
                (falloff == Falloff::none ? "CeilingWithin" : "CeilingFading") +
                std::to_string(static_cast<int>(100.0f * limit));
            const Definition definition = {.max_distance = limit, .falloff = falloff};
            // five steps in place of the falloff: .018 at most where all is equally far
            const double masks = falloff == Falloff::none ? 0.01 : 0.018;
            worlds.push_back({name,
                              wide,
                              {{{0.3, 0.2, 0}, kUp}, {{-7.1, 3.3, 0}, kUp}},
                              answer,
                              {kRaysNoise, masks, masks, masks},
                              false,
                              definition});
            if (limit < 1.3f)  // farther out the ceiling ends
                worlds.push_back({name + "OverAFloor",
                                  fine,
                                  {{{0, 0, 0}, kUp}},
                                  answer,
                                  {kRaysNoise, 0.02, 0.02, 0.02,
                                   limit < 1.0f               ? 0.0
                                   : falloff == Falloff::none ? 0.02
                                                              : 0.01},
                                  false,
                                  definition});
        }
    }
}

// 7/8 of Bunnell's weights lie within 75 degrees of the normal; within a facing disk's 45 degrees
// the integral of 1 / (2 pi).
void add_bunnell(Worlds& worlds)
{
    const Definition bunnell = {.kernel = Kernel::bunnell};
    worlds.push_back({"BunnellInASphere",
                      scenes::flipped(scenes::sphere({0, 0, 0}, 1.0, 24)),
                      {{{0, 0, 0}, kUp}},
                      always(0.875),
                      {.rays = kRaysNoise, .disks_best = 0.01},
                      false,
                      bunnell});
    worlds.push_back({"BunnellUnderADisk",
                      disk(1.0) + speck({-0.1, -0.1, -0.5}),
                      {{{0, 0, 0}, kUp}},
                      always(1.0 - std::sqrt(0.5)),
                      {.rays = kRaysNoise + 1e-3},
                      false,
                      bunnell});
}

}  // namespace

std::vector<ExactWorld> exact_worlds()
{
    Worlds worlds;
    add_open_worlds(worlds);
    add_closed_worlds(worlds);
    add_walls(worlds);
    add_disks(worlds);
    add_spheres(worlds);
    add_ceilings(worlds);
    add_bunnell(worlds);
    return worlds;
}

}  // namespace surfelao
