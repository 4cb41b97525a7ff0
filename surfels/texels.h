/// texels.h: which texels of a map a surface covers, and at which of its points each is asked.
///
/// A texel stands for the surface that a viewer shows with it. One whose centre lies in a triangle
/// (in the plane of the map) is asked there. One that triangles cover in part only, as at the
/// border of a chart, is asked at the centroid of the largest part: never outside of the surface,
/// never on its border. Where the surface lies on itself in the map (mirrored halves, tiles), a
/// texel is asked on each sheet.
///
/// The map's rows run down, and so does v: row 0 lies at v = 0 (glTF's way; readers of other
/// formats turn it). The centre of the texel (x, y) is ((x + .5) / width, (y + .5) / height).
#pragma once

#include "surfels/geometry.h"
#include "surfels/scene.h"
#include "surfels/surface.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

template <class Item>
class Buckets;

/// Where a point of the surface lies in the map; nothing where its triangle has no place there.
[[nodiscard]] std::optional<glm::dvec2> uv_at(const Geometry& geometry, const UvSet& uvs,
                                              const SurfacePoint& point);

/// Texels of one side of a map.
inline constexpr std::uint32_t kMostTexels = 32768;

struct MapSize {
    std::uint32_t width = 0, height = 0;  ///< 1 to kMostTexels
    [[nodiscard]] std::uint64_t count() const { return std::uint64_t{width} * height; }
    bool operator==(const MapSize&) const = default;
};

/// Parts of texels below this share are left out, unless their triangle would have no texel at all:
/// what is so small is a matter of rounding, and no filter shows it.
inline constexpr double kLeastPart = 1e-4;

/// A texel and a point of the surface that it shows.
struct Texel {
    std::uint32_t x = 0, y = 0;
    SurfacePoint point;
    float share = 0.0f;  ///< of the texel that the point stands for, 0 to 1; 1 where its centre is
                         ///< covered
};

/// Where texels are wanted: those of a map, in blocks of `side` * `side`, one flag per block, row
/// by row. Without flags everywhere.
struct WantedTexels {
    std::span<const std::uint8_t> blocks = {};
    std::uint32_t side = 1;  ///< divides the map's width and height
};

/// Triangles that span more tiles than this in either direction show nothing that is to be seen.
inline constexpr double kMostTiles = 64.0;

/// A map that is covered more often than this is one that the surface repeats, as bricks do.
inline constexpr double kMostSheets = 8.0;

/// The triangles of a scene in the plane of a map. Immutable; any number of threads.
class MapRaster {
public:
    /// uvs: of the scene that the geometry was made of. Triangles reach out of [0, 1] by repeating.
    /// O(triangles). Throws SettingsError for a size out of its range.
    MapRaster(const Geometry& geometry, const UvSet& uvs, MapSize size);

    [[nodiscard]] MapSize size() const { return size_; }

    /// Triangles that show no texel: without a place in the map, without area there, or beyond
    /// kMostTiles.
    [[nodiscard]] std::uint64_t flat_triangles() const { return flat_; }
    /// 1 for each triangle that shows a texel; the others' entries are left as they are.
    void mark_shown(std::span<std::uint8_t> triangles) const;
    /// Triangles that reach out of [0, 1]: where one that does not covers the same texel, they do
    /// not count.
    [[nodiscard]] std::uint64_t outside_triangles() const { return outside_; }

    /// The triangles' areas in the map, in maps: how many times they cover it, on average.
    [[nodiscard]] double sheets() const { return sheets_; }

    /// Of the rows first <= y < first + rows: by row, then column; several for one texel where
    /// sheets lie on each other, by triangle. However a map is cut into ranges of rows, the texels
    /// are the same. O(texels and triangles of the rows), all cores; where few are wanted, a small
    /// part of it.
    [[nodiscard]] std::vector<Texel> texels(std::uint32_t first, std::uint32_t rows,
                                            const WantedTexels& wanted = {}) const;

private:
    struct Placed {
        glm::dvec2 corners[3];  ///< in texels
        std::uint32_t triangle = 0;
        bool is_outside = false;
    };
    class Strip;
    [[nodiscard]] bool has_wanted(const WantedTexels& wanted, std::uint32_t first,
                                  std::uint32_t rows) const;
    /// Rows that one thread takes at a time.
    static constexpr std::uint32_t kStripRows = 4;

    MapSize size_;
    std::vector<Placed> placed_;
    /// Those that touch each strip, rising; one may stand there twice.
    std::shared_ptr<const Buckets<std::uint32_t>> of_strip_;
    std::uint64_t flat_ = 0, outside_ = 0;
    double sheets_ = 0.0;
};

}  // namespace surfelao
