#include "surfels/edges.h"

#include "surfels/errors.h"

namespace surfelao {

Edges::Edges(const Geometry& geometry, std::span<const std::uint8_t> left_out)
    : sides_(geometry.positions.size(), [&](const auto& put) {
          const std::vector<glm::uvec3>& triangles = geometry.triangles;
          SURFELAO_CHECK(triangles.size() < (std::size_t{1} << 31) / 3);
          SURFELAO_CHECK(left_out.empty() || left_out.size() == triangles.size());
          const auto add = [&](Side side, std::uint32_t from, std::uint32_t to) {
              put(std::min(from, to), {std::max(from, to), 2 * side + (from < to ? 1u : 0u)});
          };
          for (std::uint32_t t = 0; t < triangles.size(); ++t) {
              if (!left_out.empty() && left_out[t] != 0)
                  continue;
              const std::uint32_t a = geometry.welded[triangles[t].x],
                                  b = geometry.welded[triangles[t].y],
                                  c = geometry.welded[triangles[t].z];
              add(3 * t, a, b);
              add(3 * t + 1, b, c);
              add(3 * t + 2, c, a);
          }
      })
{
}

Buckets<std::uint32_t> corners_around(const std::vector<glm::uvec3>& triangles,
                                      const std::vector<std::uint32_t>& welded)
{
    return {welded.size(), [&](const auto& put) {
                for (std::uint32_t t = 0; t < triangles.size(); ++t) {
                    put(welded[triangles[t].x], 3 * t);
                    put(welded[triangles[t].y], 3 * t + 1);
                    put(welded[triangles[t].z], 3 * t + 2);
                }
            }};
}

}  // namespace surfelao
