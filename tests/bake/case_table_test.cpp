// What went wrong in public reports of bakers, from file to file: the values that must come out.
#include "bake/bake.h"
#include "files/scene_io.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr double kCaseTolerance = 0.01;

/// `occlusion` of a file that bake() wrote: seven floats a vertex, then three bytes of colour.
std::vector<float> occlusion_in(const std::filesystem::path& ply)
{
    const std::string bytes = contents_of(ply);
    const std::string end = "end_header\n", element = "element vertex ";
    const std::size_t count = std::stoul(bytes.substr(bytes.find(element) + element.size()));
    const std::size_t coordinates = bytes.find("property double x") < bytes.size() ? 24 : 12;
    const std::size_t stride = coordinates + 16 + 3;
    std::vector<float> values(count);
    for (std::size_t v = 0; v < count; ++v)
        std::memcpy(&values[v],
                    bytes.data() + bytes.find(end) + end.size() + v * stride + coordinates,
                    sizeof(float));
    return values;
}

std::vector<float> baked_values(const std::string& name, const std::string& contents)
{
    const TemporaryFolder folder;
    BakeSettings settings;
    settings.input = folder.file(name, contents);
    settings.output = folder / "out.ply";
    static_cast<void>(bake(settings));
    return occlusion_in(settings.output);
}

std::string obj_of(const Scene& scene)
{
    const TemporaryFolder folder;
    write_obj(folder / "x.obj", scene);
    return contents_of(folder / "x.obj");
}

/// A floor and the wall behind it, each with vertices of its own.
Scene corner()
{
    const auto wall = [](double s, double t) { return glm::dvec3(-2 + 4 * s, 2, 2 * t); };
    return scenes::sheet({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 16) + scenes::grid(16, 8, wall);
}

/// A cube of split sides on a floor whose vertices are not the cube's. The side at x = -.5 comes
/// behind the floor, rows upward along y.
Scene cube_on_floor()
{
    const auto side = [](glm::dvec3 at, glm::dvec3 u, glm::dvec3 v) {
        return scenes::sheet(at, u, v, 8);
    };
    return scenes::sheet({-4.03, -4.07, 0}, {8, 0, 0}, {0, 8, 0}, 32) +
           side({-.5, .5, 0}, {0, -1, 0}, {0, 0, 1}) + side({.5, -.5, 0}, {0, 1, 0}, {0, 0, 1}) +
           side({-.5, -.5, 0}, {1, 0, 0}, {0, 0, 1}) + side({.5, .5, 0}, {-1, 0, 0}, {0, 0, 1}) +
           side({-.5, -.5, 1}, {1, 0, 0}, {0, 1, 0}) + side({-.5, .5, 0}, {1, 0, 0}, {0, -1, 0});
}
constexpr std::size_t kCubeSide = 33 * 33;

/// Two boards 5 cm apart, face to face; vertex 40 is the middle of the lower one.
Scene shelf()
{
    return scenes::sheet({-.5, -.5, 0}, {1, 0, 0}, {0, 1, 0}, 8) +
           scenes::sheet({-.5, -.5, .05}, {0, 1, 0}, {1, 0, 0}, 8);
}

/// The share of the cosine-weighted hemisphere that a square of half width w covers from a height
/// of h under its middle.
double under_a_square(double w, double h)
{
    const double a = (w / h) / std::hypot(1.0, w / h);
    return 4.0 / std::numbers::pi * a * std::atan(a);
}

struct Case {
    std::string name;
    Scene scene;
    std::size_t vertex;
    double occlusion;  ///< exact, or of a ray tracer of its own with the face's normal
};

void PrintTo(const Case& row, std::ostream* out)
{
    *out << row.name;
}

class CaseTable : public testing::TestWithParam<Case> {};

TEST_P(CaseTable, HasTheRightValue)
{
    const Case& row = GetParam();
    const std::vector<float> values = baked_values("in.obj", obj_of(row.scene));
    ASSERT_EQ(values.size(), row.scene.positions.size());
    EXPECT_NEAR(values[row.vertex], row.occlusion, kCaseTolerance);
}

INSTANTIATE_TEST_SUITE_P(
    Rows, CaseTable,
    testing::Values(Case{"floor_at_the_wall", corner(), 16 * 17 + 8, 0.500},
                    Case{"floor_before_the_wall", corner(), 15 * 17 + 8, 0.440},
                    Case{"cube_at_its_foot", cube_on_floor(), kCubeSide + 4, 0.50},
                    Case{"shelf_alone", shelf(), 40, under_a_square(0.5, 0.05)},
                    Case{
                        "shelf_on_terrain",
                        shelf() + scenes::sheet({-1000, -1000, -10}, {2000, 0, 0}, {0, 2000, 0}, 4),
                        40, under_a_square(0.5, 0.05)}),
    [](const testing::TestParamInfo<Case>& row) { return row.param.name; });

constexpr int kRings = 8, kRingCorners = 24;

/// The lower half of a ball, seen from inside, as a file without vertices of its own. noise: every
/// corner of every triangle is moved by up to this, in diagonals.
std::string bowl_as_stl(double noise)
{
    const Scene bowl = scenes::grid(kRingCorners, kRings, [](double s, double t) {
        const double around = 2 * std::numbers::pi * s, up = 0.5 * std::numbers::pi * (1 - t);
        return glm::dvec3(std::cos(around) * std::cos(up), std::sin(around) * std::cos(up),
                          -std::sin(up));
    });
    std::uint32_t state = 1;
    std::string text = "solid bowl\n";
    for (const glm::uvec3 triangle : scenes::flipped(bowl).triangles) {
        const auto distance = [&](int a, int b) {
            return glm::distance(bowl.positions[triangle[a]], bowl.positions[triangle[b]]);
        };
        if (std::min({distance(0, 1), distance(1, 2), distance(2, 0)}) < 1e-9)
            continue;  // at the bottom
        text += "facet normal 0 0 0\nouter loop\n";
        for (int corner = 0; corner < 3; ++corner) {
            text += "vertex";
            for (int axis = 0; axis < 3; ++axis) {
                state = 1664525u * state + 1013904223u;
                const double share = static_cast<double>(state >> 8) / (1 << 23) - 1.0;
                text += ' ' + std::to_string(bowl.positions[triangle[corner]][axis] * 10.0 +
                                             share * noise * 30.0);
            }
            text += '\n';
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid bowl\n";
}

TEST(Case, NoiseInTheCornersOfABowlIsNotSeen)
{
    const TemporaryFolder folder;
    BakeSettings settings;
    settings.input = folder.file("bowl.stl", bowl_as_stl(3e-7));
    settings.output = folder / "out.ply";
    static_cast<void>(bake(settings));
    const std::vector<float> values = occlusion_in(settings.output);
    const Scene scene = read_scene(settings.output);
    for (int ring = 1; ring <= kRings; ++ring) {
        const double height = -10.0 * std::cos(0.5 * std::numbers::pi * ring / kRings);
        std::vector<float> of_ring;
        for (std::size_t v = 0; v < values.size(); ++v) {
            if (std::abs(scene.positions[v].z - height) < 0.1)
                of_ring.push_back(values[v]);
        }
        ASSERT_GE(of_ring.size(), std::size_t{kRingCorners});
        const auto [low, high] = std::ranges::minmax(of_ring);
        EXPECT_LE(high - low, 0.015f) << "ring " << ring;
    }
}

TEST(Case, APieceThatFacesInwardIsTold)
{
    const TemporaryFolder folder;
    write_obj(folder / "in.obj", scenes::flipped(scenes::sphere({0, 0, 1}, 1, 8)));
    BakeSettings settings;
    settings.input = folder / "in.obj";
    settings.output = folder / "out.ply";
    const std::vector<std::string> notes = bake(settings).notes;
    ASSERT_FALSE(notes.empty());
    EXPECT_NE(notes[0].find("faces inward"), std::string::npos) << notes[0];
}

}  // namespace
}  // namespace surfelao
