#include "tests/stability/shapes.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <utility>

namespace surfelao::stability {

std::uint32_t add_grid(Scene& scene, int cells_u, int cells_v,
                       const std::function<glm::dvec3(double u, double v)>& point)
{
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (int y = 0; y <= cells_v; ++y) {
        for (int x = 0; x <= cells_u; ++x)
            scene.positions.push_back(point(double(x) / cells_u, double(y) / cells_v));
    }
    const auto at = [&](int x, int y) {
        return first + static_cast<std::uint32_t>(y * (cells_u + 1) + x);
    };
    for (int y = 0; y < cells_v; ++y) {
        for (int x = 0; x < cells_u; ++x) {
            scene.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            scene.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    }
    return first;
}

std::uint32_t add_sheet(Scene& scene, glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v, int cells)
{
    return add_grid(scene, cells, cells,
                    [=](double s, double t) { return corner + s * u + t * v; });
}

void add_box(Scene& scene, glm::dvec3 low, glm::dvec3 high, int cells)
{
    // one formula for each coordinate, so that the faces meet in the same doubles
    const auto face = [&](auto unit) {
        add_grid(scene, cells, cells,
                 [&](double u, double v) { return low + unit(u, v) * (high - low); });
    };
    face([](double u, double v) { return glm::dvec3(v, u, 0); });
    face([](double u, double v) { return glm::dvec3(u, v, 1); });
    face([](double u, double v) { return glm::dvec3(u, 0, v); });
    face([](double u, double v) { return glm::dvec3(v, 1, u); });
    face([](double u, double v) { return glm::dvec3(0, v, u); });
    face([](double u, double v) { return glm::dvec3(1, u, v); });
}

void add_sphere(Scene& scene, glm::dvec3 centre, double radius, int cells)
{
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const int around = 2 * cells;
    const auto at = [&](int ring, int step) {  // rings 1 to cells - 1 between the poles
        return first + 2 + static_cast<std::uint32_t>((ring - 1) * around + step % around);
    };
    scene.positions.push_back(centre + glm::dvec3(0, 0, radius));
    scene.positions.push_back(centre - glm::dvec3(0, 0, radius));
    for (int ring = 1; ring < cells; ++ring) {
        for (int step = 0; step < around; ++step) {
            const double b = std::numbers::pi * ring / cells;
            const double a = 2.0 * std::numbers::pi * step / around;
            scene.positions.push_back(centre + radius * glm::dvec3(std::sin(b) * std::cos(a),
                                                                   std::sin(b) * std::sin(a),
                                                                   std::cos(b)));
        }
    }
    for (int step = 0; step < around; ++step) {
        scene.triangles.push_back({first, at(1, step), at(1, step + 1)});
        for (int ring = 1; ring + 1 < cells; ++ring) {
            scene.triangles.push_back({at(ring, step), at(ring + 1, step), at(ring + 1, step + 1)});
            scene.triangles.push_back({at(ring, step), at(ring + 1, step + 1), at(ring, step + 1)});
        }
        scene.triangles.push_back({at(cells - 1, step), first + 1, at(cells - 1, step + 1)});
    }
}

void add_triangle(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c)
{
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {a, b, c});
    scene.triangles.push_back({first, first + 1, first + 2});
}

void flip(Scene& scene, std::size_t first)
{
    for (std::size_t t = first; t < scene.triangles.size(); ++t)
        std::swap(scene.triangles[t].y, scene.triangles[t].z);
}

void map(Scene& scene, const std::function<glm::dvec3(glm::dvec3)>& to)
{
    for (glm::dvec3& position : scene.positions)
        position = to(position);
}

glm::dmat3 odd_rotation()
{
    const glm::dvec3 z = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(-2, 1, 0.5)));
    return {x, glm::cross(z, x), z};
}

std::uint64_t Random::bits()
{
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
}

double Random::share()
{
    return static_cast<double>(bits() >> 11) * 0x1p-53;
}

glm::dvec3 Random::in_cube()
{
    const double x = share(), y = share();
    return {x, y, share()};
}

glm::dvec3 Random::direction()
{
    const double z = 2.0 * share() - 1.0, a = 2.0 * std::numbers::pi * share();
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
}

}  // namespace surfelao::stability
