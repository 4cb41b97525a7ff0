/// random.h: a small generator with the same numbers everywhere (SplitMix64).
#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace surfelao {

class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits()
    {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return z ^ z >> 31;
    }

    /// uniform in [0, 1)
    double share() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    /// uniform in [0, 1)^3
    glm::dvec3 in_cube()
    {
        const double x = share(), y = share();
        return {x, y, share()};
    }

    /// uniform on the sphere
    glm::dvec3 direction()
    {
        const double z = 2.0 * share() - 1.0, a = 2.0 * std::numbers::pi * share();
        const double r = std::sqrt(1.0 - z * z);
        return {r * std::cos(a), r * std::sin(a), z};
    }

private:
    std::uint64_t state_;
};

}  // namespace surfelao
