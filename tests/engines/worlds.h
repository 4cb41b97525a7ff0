/// worlds.h: scenes with known answers, for every engine: worlds_test.cpp asks each engine at each
/// setting in a loop, so a new engine is one line there and, where it is a new kind, one tolerance
/// here.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/scene.h"

#include <glm/vec3.hpp>

#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace surfelao {

/// Not held to an answer: a known limit of the engine, or asked of it in another world.
inline constexpr double kNotAsked = -1.0;

/// The tolerance of `good`.
inline constexpr double kAsGood = -2.0;

/// How far an answer may be off the right one. The rasters of masks are the same on every device.
struct Tolerances {
    double rays = kNotAsked;   ///< 4096 of them
    double draft = kNotAsked;  ///< masks
    double good = kNotAsked;   ///< masks
    double exact = kNotAsked;  ///< masks that draw every triangle
    double disks = kNotAsked;  ///< at good
    double disks_best = kNotAsked;
    double best = kAsGood;  ///< masks
};

/// A place on a surface; receivers stand off it by the offset.
struct Place {
    glm::dvec3 position;
    glm::dvec3 normal;
};

struct ExactWorld {
    std::string name;
    Scene scene;
    std::vector<Place> places;  ///< empty: all vertices
    /// From where the receiver stands, in world space, off the surface.
    std::function<double(glm::dvec3)> answer;
    Tolerances tolerances;
    bool of_mean = false;        ///< the tolerance is that of the mean of all receivers
    Definition definition = {};  ///< max_distance in world space

    friend std::ostream& operator<<(std::ostream& out, const ExactWorld& world)
    {
        return out << world.name;
    }
};

[[nodiscard]] std::vector<ExactWorld> exact_worlds();

}  // namespace surfelao
