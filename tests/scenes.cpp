#include "scenes.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace surfelao::scenes {
namespace {

/// Quads between (cells_i + 1)(cells_j + 1) vertices that `index(i, j)` names.
template <class Index>
void add_quads(Scene& scene, int cells_i, int cells_j, const Index& index)
{
    for (int j = 0; j < cells_j; ++j) {
        for (int i = 0; i < cells_i; ++i) {
            const std::uint32_t a = index(i, j);
            const std::uint32_t b = index(i + 1, j);
            const std::uint32_t c = index(i + 1, j + 1);
            const std::uint32_t d = index(i, j + 1);
            scene.triangles.push_back({a, b, c});
            scene.triangles.push_back({a, c, d});
        }
    }
}

Scene cover(Scene scene)
{
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    scene.parts = {part};
    return scene;
}

}  // namespace

Scene grid(int cells_u, int cells_v, const std::function<glm::dvec3(double s, double t)>& point)
{
    Scene scene;
    for (int j = 0; j <= cells_v; ++j)
        for (int i = 0; i <= cells_u; ++i)
            scene.positions.push_back(point(double(i) / cells_u, double(j) / cells_v));
    add_quads(scene, cells_u, cells_v,
              [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells_u + 1) + i); });
    return cover(std::move(scene));
}

Scene triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c)
{
    Scene scene;
    scene.positions = {a, b, c};
    scene.triangles = {{0, 1, 2}};
    return cover(std::move(scene));
}

Scene sheet(glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v, int cells)
{
    return grid(cells, cells, [&](double s, double t) { return corner + s * u + t * v; });
}

Scene height_field(int cells, const std::function<double(double, double)>& height)
{
    return grid(cells, cells, [&](double x, double y) { return glm::dvec3(x, y, height(x, y)); });
}

Scene box(glm::dvec3 low, glm::dvec3 high, int cells)
{
    // lattice points of the cube's surface, numbered as they are met
    Scene scene;
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;
    numbers.reserve(6 * static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells) + 2);
    const auto vertex = [&](glm::ivec3 at) {
        const auto lattice = static_cast<std::uint64_t>(cells) + 1;
        const auto place = glm::u64vec3(at);
        const auto [found, is_new] =
            numbers.try_emplace((place.z * lattice + place.y) * lattice + place.x,
                                static_cast<std::uint32_t>(scene.positions.size()));
        if (is_new)
            scene.positions.push_back(low + (high - low) * glm::dvec3(at) / double(cells));
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (int end = 0; end < 2; ++end) {
            add_quads(scene, cells, cells, [&](int i, int j) {
                glm::ivec3 at(0);
                at[axis] = end * cells;
                at[(axis + 1) % 3] = end == 1 ? i : j;  // the low side looks the other way
                at[(axis + 2) % 3] = end == 1 ? j : i;
                return vertex(at);
            });
        }
    }
    return cover(std::move(scene));
}

Scene sphere(glm::dvec3 centre, double radius, int cells)
{
    // tan spaces the cells evenly in angle
    constexpr double kQuarterPi = 0.78539816339744831;
    return moved(box(glm::dvec3(-1.0), glm::dvec3(1.0), cells), [&](glm::dvec3 p) {
        const glm::dvec3 even(std::tan(kQuarterPi * p.x), std::tan(kQuarterPi * p.y),
                              std::tan(kQuarterPi * p.z));
        return centre + radius * glm::normalize(even);
    });
}

Scene bumpy_sphere(int cells)
{
    return moved(sphere(glm::dvec3(0.0), 1.0, cells), [](glm::dvec3 p) {
        double bump = 0.0;
        double size = 0.1;
        double frequency = 4.0;
        for (int octave = 0; octave < 4; ++octave) {
            bump += size * std::sin(frequency * p.x + octave) *
                    std::sin(frequency * p.y + 2.0 * octave) * std::sin(frequency * p.z + 1.0);
            size *= 0.6;
            frequency *= 2.1;
        }
        return (1.0 + 2.0 * bump) * p;
    });
}

Scene nested_shells(int count, double gap, int cells)
{
    Scene scene;
    for (int shell = 0; shell < count; ++shell)
        scene = std::move(scene) + sphere(glm::dvec3(0.0), 1.0 - gap * shell, cells);
    return scene;
}

Scene wall_and_floor(double size, int cells)
{
    // the first half of the columns goes down the wall, the second out over the floor
    return grid(2 * cells, 2 * cells, [&](double s, double t) {
        const double y = size * (t - 0.5);
        return s < 0.5 ? glm::dvec3(0.0, y, size * (1.0 - 2.0 * s))
                       : glm::dvec3(size * (2.0 * s - 1.0), y, 0.0);
    });
}

Scene room(glm::dvec3 low, glm::dvec3 high, int cells)
{
    return flipped(box(low, high, cells));
}

Scene operator+(Scene a, const Scene& b)
{
    a += b;
    return a;
}

Scene& operator+=(Scene& a, const Scene& b)
{
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    const auto first_triangle = static_cast<std::uint32_t>(a.triangles.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const glm::uvec3& triangle : b.triangles)
        a.triangles.push_back(triangle + first);
    for (Part part : b.parts) {
        part.first_vertex += first;
        part.first_triangle += first_triangle;
        a.parts.push_back(part);
    }
    return a;
}

Scene moved(Scene scene, const std::function<glm::dvec3(glm::dvec3)>& place)
{
    for (glm::dvec3& position : scene.positions)
        position = place(position);
    return scene;
}

Scene flipped(Scene scene)
{
    for (glm::uvec3& triangle : scene.triangles)
        std::swap(triangle.y, triangle.z);
    return scene;
}

}  // namespace surfelao::scenes
