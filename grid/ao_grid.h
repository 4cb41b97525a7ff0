/// ao_grid.h: what an object hides from any point about it, in a grid of cells round it.
///
/// A cell holds how much of the whole sphere the object covers, and where: with V(w) = 1 where the
/// object is hit from the cell along w,
///
///     alpha = 1/(4 pi) integral V dw      in [0, 1]
///     m     = integral V w dw             |m| <= 4 pi alpha
///
/// (GridStore::cone; a baked cell's are moved to the cone that receivers there read best), or V
/// projected on nine real spherical harmonics (GridStore::sh). A receiver of any normal reads its
/// occlusion from what lies between the eight cells around it.
///
/// Cells are places: those of the box's faces lie on it, `cells` an axis. They stand closer by the
/// object: along each axis, x from the middle of the box in half its size, u the same of the grid,
///
///     u = sign(x) (|x| < a ? s |x| / a : s + (1 - s) (|x| - a) / (1 - a))
///
/// Beyond the box nothing is hidden; GridBorder says how the values come to that.
///
/// Based on:
///   Kontkanen, Laine. Ambient Occlusion Fields. I3D 2005
///   Malmer, Malmer, Assarsson, Holzschuch. Fast Precomputed Ambient Occlusion for Proximity
///   Shadows. JGT 12(2). 2007
///   Ramamoorthi, Hanrahan. An Efficient Representation for Irradiance Environment Maps. 2001
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace surfelao {

enum class GridStore {
    cone,  ///< four numbers: m / (4 pi) and alpha
    sh,    ///< nine: coefficients of V, l = 0, 1, 2, m from -l to l
};
[[nodiscard]] constexpr std::size_t channels_of(GridStore store)
{
    return store == GridStore::cone ? 4 : 9;
}
/// "cone", "sh"
[[nodiscard]] std::string name_of(GridStore store);

/// What is done about the step where the box ends.
enum class GridBorder {
    fade,     ///< what is read falls smoothly to 0 over the last kGridFade of the box
    rescale,  ///< alpha becomes (alpha - V_M) / (1 - V_M), at least 0; the rest as much less
};
/// "fade", "rescale"
[[nodiscard]] std::string name_of(GridBorder border);

inline constexpr float kGridFade = 0.12f;  ///< of half the box, measured

struct AoGrid {
    glm::ivec3 cells{0};             ///< per axis, >= 2
    glm::dvec3 low{0.0}, high{0.0};  ///< of the box, in the object's own units; low < high
    /// a, per axis: the object, in half the box; in (0, 1). Evenly spaced cells: equal to s.
    glm::vec3 inner{0.65f};
    float inner_share = 0.65f;  ///< s, in (0, 1)
    GridStore store = GridStore::cone;
    GridBorder border = GridBorder::fade;
    float border_value = 0.0f;  ///< V_M: the largest alpha of the cells on the box's faces
    /// channels_of(store) a cell, x fastest, then y, then z.
    std::vector<float> values;

    [[nodiscard]] std::size_t cell_count() const
    {
        return static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y) *
               static_cast<std::size_t>(cells.z);
    }
    [[nodiscard]] std::size_t index_of(glm::ivec3 cell) const
    {
        return static_cast<std::size_t>(cell.x) +
               static_cast<std::size_t>(cells.x) *
                   (static_cast<std::size_t>(cell.y) +
                    static_cast<std::size_t>(cells.y) * static_cast<std::size_t>(cell.z));
    }
};

/// From x in half the box to u in half the grid, both in [-1, 1], and back; a, s as above. The
/// identity where they are equal.
[[nodiscard]] float warped(float x, float a, float s);
[[nodiscard]] float unwarped(float u, float a, float s);

/// Where a cell stands, or a place between cells, in the object's units.
[[nodiscard]] glm::dvec3 place_of(const AoGrid& grid, glm::vec3 cell);

/// The eight cells round a place of the object's space that lies in the box, by index, and what
/// each counts for it: >= 0, 1 together.
struct CellBlend {
    std::array<std::size_t, 8> cells;
    std::array<float, 8> weights;
};
[[nodiscard]] CellBlend blend_at(const AoGrid& grid, glm::dvec3 place);

/// What is read at a place of the object's space: channels_of(store) values, blended between eight
/// cells, border not applied. Beyond the box: zeros.
void read_values(const AoGrid& grid, glm::dvec3 place, float* values);

/// By what the values read at a place are multiplied for the border; alpha: what they tell of the
/// whole sphere. fade: 3 t^2 - 2 t^3, t = (1 - |x|) / kGridFade in [0, 1], x in half the box along
/// the axis where the place is farthest out. rescale: (alpha - V_M) / (1 - V_M) / alpha, at least
/// 0. In [0, 1]; 0 beyond the box.
[[nodiscard]] float border_weight(const AoGrid& grid, glm::dvec3 place, float alpha);

/// read_values() times border_weight().
void read_values_in_border(const AoGrid& grid, glm::dvec3 place, float* values);

/// The occlusion by the object at a place of its own space, with a normal of unit length: of the
/// blended cone or harmonics, with the border. In [0, 1]; 0 beyond the box.
[[nodiscard]] float occlusion_at(const AoGrid& grid, glm::dvec3 place, glm::vec3 normal);

/// Of one cell's values, without a border: the cone's (cone.h), or
/// sum A_l / pi c_lm Y_lm(normal), cut to [0, 1].
[[nodiscard]] float occlusion_of(GridStore store, const float* values, glm::vec3 normal);

}  // namespace surfelao
