/// occupancy.h: triangles laid side by side on planes, none on another.
///
/// Internal: for charts.cpp.
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace surfelao {

using FlatTriangle = std::array<glm::dvec2, 3>;  ///< counterclockwise where y runs up

/// Twice the area, positive counterclockwise.
[[nodiscard]] double twice_area(const FlatTriangle& triangle);

/// Whether the inner sides of two counterclockwise triangles have a point in common. Exact where
/// they share corners, to rounding elsewhere, and then on the safe side.
[[nodiscard]] bool overlap(const FlatTriangle& a, const FlatTriangle& b);

/// Any number of planes ("sheets"), all of them in one hash of cells. A triangle lies in the cells
/// of a grid as coarse as itself, at most four; so a question costs the cells around it and, of
/// much finer grids, at most as many steps as there are triangles.
class Occupancy {
public:
    /// expected: triangles in all.
    explicit Occupancy(std::size_t expected);

    /// An empty plane.
    [[nodiscard]] std::uint32_t add_sheet();

    /// Whether the triangle is counterclockwise and lies on none of the sheet's.
    [[nodiscard]] bool fits(std::uint32_t sheet, const FlatTriangle& triangle) const;

    void add(std::uint32_t sheet, const FlatTriangle& triangle);

    /// Takes off the triangles that were added last to this sheet; no other sheet may have been
    /// added to since.
    void drop_last(std::uint32_t sheet, std::size_t count);

private:
    struct Level {
        int exponent = 0;                   ///< cells are 2^exponent wide
        std::vector<std::uint32_t> placed;  ///< in the order in which they came
    };
    struct Placed {
        FlatTriangle corners;
        std::uint32_t first_entry;
        std::int16_t exponent;
    };
    struct Entry {
        std::uint32_t sheet, placed, next;
        std::uint32_t slot;
    };

    [[nodiscard]] std::uint32_t slot_of(std::uint32_t sheet, int exponent, std::int64_t x,
                                        std::int64_t y) const;

    std::vector<std::vector<Level>> sheets_;
    std::vector<Placed> placed_;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> heads_;
};

}  // namespace surfelao
