#include "family.h"

#include "random.h"
#include "scenes.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace surfelao::scenes {
namespace {

using std::numbers::pi;

/// Numbers for one scene.
class Dice : public Random {
public:
    using Random::Random;
    double in(double low, double high) { return low + (high - low) * share(); }
    int from(int low, int high)  ///< both ends included
    {
        return low + static_cast<int>(share() * (high - low + 1));
    }
    bool chance(double probability) { return share() < probability; }
    glm::dvec3 within(glm::dvec3 low, glm::dvec3 high) { return low + (high - low) * in_cube(); }
};

// ------------------------------------------------------------------------------------------------
// what scenes are built of

/// A smooth function of a place, about -1 to 1: a few waves in directions of their own.
class Waves {
public:
    Waves(Dice& dice, double frequency, int count = 6)
    {
        for (int i = 0; i < count; ++i)
            waves_.push_back(
                {dice.direction() * (frequency * dice.in(0.6, 1.4)), dice.in(0.0, 2.0 * pi)});
    }
    double operator()(glm::dvec3 p) const
    {
        double sum = 0.0;
        for (const Wave& wave : waves_)
            sum += std::sin(glm::dot(wave.direction, p) + wave.phase);
        return sum / std::sqrt(0.5 * static_cast<double>(waves_.size())) / 1.8;
    }

private:
    struct Wave {
        glm::dvec3 direction;
        double phase;
    };
    std::vector<Wave> waves_;
};

/// Octaves of waves, each half as high and twice as fine.
std::function<double(glm::dvec3)> fractal(Dice& dice, double frequency, int octaves, double decay)
{
    std::vector<Waves> layers;
    for (int i = 0; i < octaves; ++i)
        layers.emplace_back(dice, frequency * std::pow(2.0, i));
    return [layers, decay](glm::dvec3 p) {
        double sum = 0.0, weight = 1.0;
        for (const Waves& layer : layers) {
            sum += weight * layer(p);
            weight *= decay;
        }
        return sum;
    };
}

glm::dvec3 turned(const glm::dquat& rotation, glm::dvec3 p)
{
    return rotation * p;
}

glm::dquat any_rotation(Dice& dice)
{
    const glm::dvec3 axis = dice.direction();
    return glm::angleAxis(dice.in(0.0, 2.0 * pi), axis);
}

/// A tube of `radius(t)` along the curve, closed where the curve is; sides * rings quads.
Scene tube(int sides, int rings, bool closed, const std::function<glm::dvec3(double)>& curve,
           const std::function<double(double)>& radius)
{
    // a frame that is carried along the curve without twisting
    std::vector<glm::dvec3> normals;
    glm::dvec3 normal(0.0);
    for (int i = 0; i <= rings; ++i) {
        const double t = double(i) / rings;
        const glm::dvec3 along = glm::normalize(curve(t + 1e-4) - curve(t - 1e-4));
        if (i == 0)
            normal = std::abs(along.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
        normal = glm::normalize(normal - glm::dot(normal, along) * along);
        normals.push_back(normal);
    }
    double twist = 0.0;  // between the two ends of a closed curve
    if (closed) {
        const glm::dvec3 along = glm::normalize(curve(1e-4) - curve(-1e-4));
        twist = std::atan2(glm::dot(glm::cross(normals.front(), normals.back()), along),
                           glm::dot(normals.front(), normals.back()));
    }
    Scene scene;
    const auto vertex = [&](int side, int ring) {
        if (closed)
            ring %= rings;
        return static_cast<std::uint32_t>(ring * sides + side % sides);
    };
    for (int ring = 0; ring < (closed ? rings : rings + 1); ++ring) {
        const double t = double(ring) / rings;
        const glm::dvec3 along = glm::normalize(curve(t + 1e-4) - curve(t - 1e-4));
        const glm::dvec3 u = normals[static_cast<std::size_t>(ring)];
        const glm::dvec3 v = glm::cross(along, u);
        for (int side = 0; side < sides; ++side) {
            const double angle = 2.0 * pi * side / sides - twist * t;
            scene.positions.push_back(curve(t) +
                                      radius(t) * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }
    for (int ring = 0; ring < rings; ++ring) {
        for (int side = 0; side < sides; ++side) {
            const std::uint32_t a = vertex(side, ring), b = vertex(side + 1, ring);
            const std::uint32_t c = vertex(side + 1, ring + 1), d = vertex(side, ring + 1);
            scene.triangles.push_back({a, b, c});
            scene.triangles.push_back({a, c, d});
        }
    }
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    scene.parts = {part};
    return scene;
}

std::function<glm::dvec3(double)> closed_curve(Dice& dice)
{
    std::array<glm::dvec3, 3> a{}, b{};
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = dice.direction() / (1.0 + double(i));
        b[i] = dice.direction() / (1.0 + double(i));
    }
    return [a, b](double t) {
        glm::dvec3 p(0.0);
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double angle = 2.0 * pi * (double(i) + 1.0) * t;
            p += std::cos(angle) * a[i] + std::sin(angle) * b[i];
        }
        return p;
    };
}

/// A body that is smooth and somewhere hollow.
Scene body(Dice& dice, int cells)
{
    if (dice.chance(0.4)) {
        const double thick = dice.in(0.12, 0.4);
        const int rings = 6 * cells, sides = std::max(8, cells);
        const Waves waves(dice, 6.0);
        return tube(sides, rings, true, closed_curve(dice), [=](double t) {
            return thick * (1.0 + 0.3 * waves({std::cos(2 * pi * t), std::sin(2 * pi * t), 0.0}));
        });
    }
    const double depth = dice.in(0.15, 0.45);
    const Waves waves(dice, dice.in(1.5, 5.0));
    const glm::dvec3 stretch = dice.within(glm::dvec3(0.5), glm::dvec3(1.2));
    return moved(sphere(glm::dvec3(0.0), 1.0, cells),
                 [&](glm::dvec3 p) { return stretch * p * (1.0 + depth * waves(p)); });
}

/// A plain box, each side a grid of its own of squares of about `square`, edges not shared.
Scene block(glm::dvec3 low, glm::dvec3 high, double square)
{
    Scene scene;
    for (int axis = 0; axis < 3; ++axis) {
        for (int end = 0; end < 2; ++end) {
            glm::dvec3 corner = low, u(0.0), v(0.0);
            corner[axis] = end == 1 ? high[axis] : low[axis];
            const int first = (axis + (end == 1 ? 1 : 2)) % 3,
                      second = (axis + (end == 1 ? 2 : 1)) % 3;
            u[first] = high[first] - low[first];
            v[second] = high[second] - low[second];
            const auto cells = [&](glm::dvec3 side) {
                return std::clamp(static_cast<int>(std::ceil(glm::length(side) / square)), 1, 60);
            };
            scene += grid(cells(u), cells(v),
                          [&](double s, double t) { return corner + s * u + t * v; });
        }
    }
    return scene;
}

/// A prism over a polygon in the plane z = 0, its faces fans and its sides long rectangles.
Scene prism(const std::vector<glm::dvec2>& outline, double height)
{
    Scene scene;
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (const double z : {0.0, height})
        for (const glm::dvec2 p : outline)
            scene.positions.emplace_back(p.x, p.y, z);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        scene.triangles.push_back({i, next, count + next});
        scene.triangles.push_back({i, count + next, count + i});
        if (i > 0 && next != 0) {
            scene.triangles.push_back({0, next, i});
            scene.triangles.push_back({count, count + i, count + next});
        }
    }
    Part part;
    part.vertex_count = 2 * count;
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    scene.parts = {part};
    return scene;
}

std::vector<glm::dvec2> regular(int corners, double radius, double phase = 0.0)
{
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < corners; ++i) {
        const double angle = phase + 2.0 * pi * i / corners;
        outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return outline;
}

Scene placed(Scene scene, const glm::dquat& rotation, glm::dvec3 at, double size = 1.0)
{
    return moved(std::move(scene), [&](glm::dvec3 p) { return at + size * turned(rotation, p); });
}

/// Without the triangles for which `gone(middle)`; vertices stay.
Scene without(Scene scene, const std::function<bool(glm::dvec3)>& gone)
{
    std::erase_if(scene.triangles, [&](glm::uvec3 t) {
        return gone((scene.positions[t.x] + scene.positions[t.y] + scene.positions[t.z]) / 3.0);
    });
    scene.parts.resize(1);
    scene.parts[0].vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    scene.parts[0].triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    return scene;
}

// ------------------------------------------------------------------------------------------------
// the kinds

Scene rough(Dice& dice, double edges)
{
    const int cells = dice.from(16, 40);
    const double edge = 1.6 / cells;  // about, on a unit sphere
    const Waves coarse(dice, dice.in(1.5, 4.0));
    const Waves fine(dice, 2.0 * pi / (edge * edges), 12);
    const double height = edge * edges * dice.in(0.05, 0.25), depth = dice.in(0.1, 0.4);
    return moved(sphere(glm::dvec3(0.0), 1.0, cells),
                 [&](glm::dvec3 p) { return p * (1.0 + depth * coarse(p) + height * fine(p)); });
}

Scene open_scan(Dice& dice)
{
    Scene scene =
        dice.chance(0.5) ? rough(dice, dice.in(2.0, 16.0)) : body(dice, dice.from(16, 36));
    std::vector<std::pair<glm::dvec3, double>> holes;
    for (int i = dice.from(1, 8); i > 0; --i)
        holes.emplace_back(dice.direction() * dice.in(0.6, 1.1), dice.in(0.1, 0.45));
    const double below = dice.in(-1.2, -0.3);
    return without(std::move(scene), [&](glm::dvec3 p) {
        return p.z < below || std::ranges::any_of(holes, [&](const auto& hole) {
                   return glm::length(p - hole.first) < hole.second;
               });
    });
}

Scene thin(Dice& dice)
{
    Scene scene;
    for (int i = dice.from(4, 14); i > 0; --i) {
        const glm::dquat rotation = any_rotation(dice);
        const glm::dvec3 at = dice.within(glm::dvec3(-0.8), glm::dvec3(0.8));
        if (dice.chance(0.5)) {
            const glm::dvec3 half{dice.in(0.2, 0.7), dice.in(0.2, 0.7), dice.in(0.003, 0.03)};
            scene += placed(block(-half, half, dice.in(0.06, 0.2)), rotation, at);
        } else {
            const auto curve = closed_curve(dice);
            const double radius = dice.in(0.01, 0.05);
            scene +=
                placed(tube(6, dice.from(60, 160), true, curve, [=](double) { return radius; }),
                       rotation, at, 0.6);
        }
    }
    return scene;
}

Scene doubled(Dice& dice)
{
    const Scene inner = body(dice, dice.from(14, 28));
    const double gap = dice.in(0.003, 0.06);
    Scene outer = moved(inner, [&](glm::dvec3 p) { return p * (1.0 + gap); });
    if (dice.chance(0.5)) {  // a coat that is open in front
        const double front = dice.in(0.1, 0.6);
        outer = without(std::move(outer), [&](glm::dvec3 p) { return p.x > front; });
    }
    return inner + outer;
}

/// Every vertex moved by a share of its edges, every second diagonal turned.
Scene remeshed(Dice& dice)
{
    Scene scene = body(dice, dice.from(16, 36));
    const std::size_t pairs = scene.triangles.size() / 2;
    for (std::size_t i = 0; i < pairs; ++i) {
        glm::uvec3& a = scene.triangles[2 * i];
        glm::uvec3& b = scene.triangles[2 * i + 1];
        if (a.x == b.x && a.z == b.y && dice.chance(0.5)) {
            const glm::uvec4 quad(a.x, a.y, a.z, b.z);
            a = {quad.x, quad.y, quad.w};
            b = {quad.y, quad.z, quad.w};
        }
    }
    std::vector<double> edges(scene.positions.size(), 1e30);
    for (const glm::uvec3 t : scene.triangles)
        for (int k = 0; k < 3; ++k)
            edges[t[k]] = std::min(
                edges[t[k]], glm::length(scene.positions[t[k]] - scene.positions[t[(k + 1) % 3]]));
    const double share = dice.in(0.1, 0.3);
    for (std::size_t v = 0; v < scene.positions.size(); ++v)
        if (edges[v] < 1e30)
            scene.positions[v] += share * edges[v] * dice.direction();
    return scene;
}

Scene adaptive(Dice& dice)
{
    const int cells = dice.from(40, 90);
    const double power = dice.in(1.5, 3.5);
    const auto relief = fractal(dice, dice.in(2.0, 5.0), 4, 0.5);
    const double height = dice.in(0.05, 0.25);
    const auto uneven = [&](double t) {
        const double away = 2.0 * t - 1.0;
        return std::copysign(std::pow(std::abs(away), power), away);
    };
    return grid(cells, cells, [&](double s, double t) {
        const glm::dvec3 p(uneven(s), uneven(t), 0.0);
        return p + glm::dvec3(0, 0, height * relief(p));
    });
}

Scene cad(Dice& dice)
{
    Scene scene;
    for (int i = dice.from(3, 8); i > 0; --i) {
        const int corners = dice.chance(0.5) ? dice.from(3, 8) : dice.from(24, 96);
        const glm::dvec3 at = dice.within(glm::dvec3(-1, -1, 0), glm::dvec3(1, 1, 0.5));
        scene +=
            placed(prism(regular(corners, dice.in(0.1, 0.6), dice.in(0.0, pi)), dice.in(0.05, 1.0)),
                   glm::dquat(1, 0, 0, 0), at);
    }
    for (int i = dice.from(1, 4); i > 0; --i) {  // pipes, open at their ends
        const double radius = dice.in(0.05, 0.3), length = dice.in(0.3, 1.2);
        const glm::dvec3 at = dice.within(glm::dvec3(-1, -1, 0), glm::dvec3(1, 1, 0.8));
        const auto wall = [&](double r) {
            return tube(
                dice.from(12, 48), dice.from(1, 4), false,
                [=](double t) { return glm::dvec3(0, 0, length * t); }, [=](double) { return r; });
        };
        scene += placed(wall(radius) + flipped(wall(0.85 * radius)), any_rotation(dice), at);
    }
    return scene + block({-1.3, -1.3, -0.1}, {1.3, 1.3, 0.0}, dice.in(0.2, 3.0));
}

Scene hard_edged(Dice& dice)
{
    Scene scene;
    const double square = dice.in(0.05, 0.15);
    const int steps = dice.from(3, 9);
    for (int i = 0; i < steps; ++i)
        scene += block({0.3 * i, -1.0, -0.2}, {0.3 * (i + 1), 1.0, 0.2 * (i + 1)}, square);
    for (int i = dice.from(2, 6); i > 0; --i) {
        const glm::dvec3 low = dice.within({0, -1, 0}, {2, 0.8, 1});
        scene += block(low, low + dice.within(glm::dvec3(0.2), glm::dvec3(0.7)), square);
    }
    return scene;
}

Scene foliage(Dice& dice)
{
    Scene scene;
    const int twigs = dice.from(6, 16), leaves = dice.from(20, 70);
    for (int i = 0; i < twigs; ++i) {
        const glm::dvec3 from = dice.within(glm::dvec3(-0.2), glm::dvec3(0.2));
        const glm::dvec3 to = from + dice.direction() * dice.in(0.5, 1.2);
        const double radius = dice.in(0.01, 0.03);
        scene += tube(
            5, 6, false, [=](double t) { return from + t * (to - from); },
            [=](double t) { return radius * (1.1 - t); });
        for (int leaf = 0; leaf < leaves; ++leaf) {
            const glm::dvec3 at = from + dice.in(0.2, 1.0) * (to - from);
            const double size = dice.in(0.04, 0.12), bend = dice.in(0.0, 0.5);
            const int cells = dice.from(1, 3);
            scene += placed(grid(cells, 2 * cells,
                                 [=](double s, double t) {
                                     const double wide =
                                         (s - 0.5) * std::sin(pi * (0.15 + 0.8 * t));
                                     return glm::dvec3(wide, t + 0.2, bend * t * t);
                                 }),
                            any_rotation(dice), at, size);
        }
    }
    return scene;
}

Scene room(Dice& dice)
{
    const glm::dvec3 size = dice.within({2.0, 2.0, 1.0}, {5.0, 4.0, 2.0});
    const double square = dice.in(0.1, 1.0);
    const bool window = dice.chance(0.6);
    Scene scene = flipped(block(glm::dvec3(0.0), size, square));
    if (window) {
        const glm::dvec2 low{dice.in(0.1, 0.4) * size.y, dice.in(0.2, 0.4) * size.z};
        const glm::dvec2 high = low + glm::dvec2(0.4 * size.y, 0.4 * size.z);
        scene = without(std::move(scene), [&](glm::dvec3 p) {
            return p.x < 1e-6 && p.y > low.x && p.y < high.x && p.z > low.y && p.z < high.y;
        });
    }
    for (int i = dice.from(3, 12); i > 0; --i) {
        const glm::dvec3 extent = dice.within(glm::dvec3(0.15), glm::dvec3(0.9));
        glm::dvec3 low = dice.within(glm::dvec3(0.05), size - extent);
        low.z = dice.chance(0.8) ? 0.0 : low.z;
        if (dice.chance(0.7))
            scene += block(low, low + extent, square * dice.in(0.3, 1.0));
        else
            scene += moved(body(dice, dice.from(8, 16)),
                           [&](glm::dvec3 p) { return low + extent * (0.5 + 0.25 * p); });
    }
    return scene;
}

Scene town(Dice& dice)
{
    const int wide = dice.from(3, 8);
    const double square = dice.in(0.1, 0.8);
    Scene scene = block({-0.5, -0.5, -0.2}, {wide + 0.5, wide + 0.5, 0.0}, dice.in(0.1, 1.0));
    for (int x = 0; x < wide; ++x) {
        for (int y = 0; y < wide; ++y) {
            if (dice.chance(0.2))
                continue;
            const glm::dvec2 low{x + dice.in(0.0, 0.25), y + dice.in(0.0, 0.25)};
            const glm::dvec2 high{x + dice.in(0.6, 0.95), y + dice.in(0.6, 0.95)};
            const double top = dice.in(0.2, 2.5);
            scene += block({low.x, low.y, 0.0}, {high.x, high.y, top}, square);
            if (dice.chance(0.3))
                scene += block({low.x + 0.1, low.y + 0.1, top},
                               {high.x - 0.1, high.y - 0.1, top + 0.2}, square);
        }
    }
    return scene;
}

Scene assembly(Dice& dice)
{
    Scene scene;
    for (int i = dice.from(15, 60); i > 0; --i) {
        const glm::dvec3 at = dice.within(glm::dvec3(-1.0), glm::dvec3(1.0));
        const glm::dquat rotation = dice.chance(0.6) ? glm::dquat(1, 0, 0, 0) : any_rotation(dice);
        const double size = dice.in(0.1, 0.5);
        switch (dice.from(0, 3)) {
            case 0:
                scene +=
                    placed(block(glm::dvec3(-0.5), dice.within(glm::dvec3(0.0), glm::dvec3(0.6)),
                                 dice.in(0.1, 1.0)),
                           rotation, at, size);
                break;
            case 1:
                scene += placed(prism(regular(dice.from(6, 40), 0.5), dice.in(0.1, 1.5)), rotation,
                                at, size);
                break;
            case 2: {  // a spring
                const int turns = dice.from(2, 6);
                const double pitch = dice.in(0.2, 0.5);
                scene += placed(tube(
                                    6, 14 * turns, false,
                                    [=](double t) {
                                        const double angle = 2.0 * pi * turns * t;
                                        return glm::dvec3(0.5 * std::cos(angle),
                                                          0.5 * std::sin(angle), pitch * turns * t);
                                    },
                                    [](double) { return 0.06; }),
                                rotation, at, size);
                break;
            }
            default:
                scene += placed(sphere(glm::dvec3(0.0), 0.5, dice.from(3, 8)), rotation, at, size);
        }
    }
    return scene;
}

Scene terrain(Dice& dice, int cells, double size)
{
    const auto relief = fractal(dice, dice.in(2.0, 5.0) / size, dice.from(4, 6), dice.in(0.4, 0.6));
    const double height = size * dice.in(0.05, 0.2);
    return grid(cells, cells, [&](double s, double t) {
        const glm::dvec3 p(size * (s - 0.5), size * (t - 0.5), 0.0);
        return p + glm::dvec3(0, 0, height * relief(p));
    });
}

Scene mixed_scale(Dice& dice)
{
    const double size = std::pow(10.0, dice.in(0.7, 2.0));
    const bool flat = dice.chance(0.5);
    Scene scene =
        flat ? sheet({-size / 2, -size / 2, 0}, {size, 0, 0}, {0, size, 0}, dice.from(1, 20))
             : terrain(dice, dice.from(10, 40), size);
    for (int i = dice.from(2, 6); i > 0; --i) {
        const glm::dvec3 at = dice.within({-2, -2, flat ? 0.3 : 0.0}, {2, 2, 1.0});
        const double small = std::pow(10.0, dice.in(-1.0, 0.0));
        scene += placed(body(dice, dice.from(8, 18)), any_rotation(dice), at, small);
    }
    return scene;
}

Scene make(std::uint32_t kind, Dice& dice)
{
    switch (kind) {
        case 0:
            return body(dice, dice.from(14, 44));
        case 1:
            return rough(dice, 2.0);
        case 2:
            return rough(dice, dice.in(6.0, 20.0));
        case 3:
            return open_scan(dice);
        case 4:
            return thin(dice);
        case 5:
            return doubled(dice);
        case 6:
            return remeshed(dice);
        case 7:
            return adaptive(dice);
        case 8:
            return cad(dice);
        case 9:
            return hard_edged(dice);
        case 10:
            return foliage(dice);
        case 11:
            return room(dice);
        case 12:
            return town(dice);
        case 13:
            return assembly(dice);
        case 14:
            return mixed_scale(dice);
        default:
            return terrain(dice, dice.from(30, 100), 1.0);
    }
}

}  // namespace

const char* family_kind(std::uint32_t index)
{
    return kFamilyKinds[index % kFamilyKindCount];
}

Half half_of(std::uint32_t index)
{
    return index / kFamilyKindCount % 2 == 0 ? Half::choosing : Half::judging;
}

Scene family_scene(std::uint32_t index)
{
    if (index >= kFamilySize)
        throw std::out_of_range("the family has fewer scenes");
    Dice dice(0x5eedu + 7919u * index);
    const Scene made = make(index % kFamilyKindCount, dice);
    Scene scene = placed(made, any_rotation(dice), glm::dvec3(0.0));
    scene.name = std::string(family_kind(index))
                     .append("_")
                     .append(std::to_string(index / kFamilyKindCount));
    return scene;
}

}  // namespace surfelao::scenes
