/// nearest.h: the nearest of many points, by a k-d tree (nanoflann).
///
/// Based on:
///   Friedman, Bentley, Finkel. An Algorithm for Finding Best Matches in Logarithmic Expected Time.
///     1977
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// Immutable: any number of threads may ask at once.
class NearestPoints {
public:
    /// At least one point, all finite. O(n log n), one core.
    explicit NearestPoints(std::vector<glm::vec3> points);
    ~NearestPoints();
    NearestPoints(const NearestPoints&) = delete;
    NearestPoints& operator=(const NearestPoints&) = delete;

    /// The nearest of all points to a place, nearest first, as many as `indices` takes or as there
    /// are, with the squares of their distances: of the same size. Returns their number. A point
    /// at the place itself is one of them. O(log n + k^2), equal input gives equal answers.
    std::size_t find(glm::vec3 place, std::span<std::uint32_t> indices,
                     std::span<float> distances2) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace surfelao
