#include "bake/grid_fit.h"

#include "bake/normal_equations.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstddef>
#include <map>

namespace surfelao {
namespace {

/// In each cube that the surface cuts, inside or not. Mean error of harmonics and of cones over an
/// open and a thin scene of the choosing half: .0162 and .0186 without, .0149 and .0175 with two,
/// .0147 and .0173 with four. Told from two to four by others, 32 cells: bunny .0095 and .0144 to
/// .0085 and .0137, spot .0104 and .0160 to .0099 and .0157, skull and boat the same, wingnut .0120
/// and .0189 to .0130 and .0194.
constexpr int kPlacesACube = 4;

/// What a cell's own value counts, in places: so little that it decides only where they leave it
/// free. With four places, the same scenes: .02 .0146 and .0172, .5 .0150 and .0176. To fit the
/// cells outside too, with weights of 1, gains nothing.
constexpr float kOwnWeight = 0.1f;

/// Values are told to about a thousandth: finer is lost in them.
constexpr double kFitTolerance = 1e-3;
constexpr int kMostFitSteps = 50;

constexpr std::uint32_t kNotFitted = 0xffffffff;

/// Even over the unit cube, any number of them: multiples of powers of the root of x^4 = x + 1
/// (Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018).
glm::vec3 in_unit_cube(std::size_t k)
{
    const glm::dvec3 step(0.8191725133961644, 0.6710436067037893, 0.5497004779019703);
    return glm::vec3(glm::fract(step * static_cast<double>(k + 1)));
}

/// Where the surface passes between cells.
bool is_cut(const AoGrid& grid, std::span<const std::uint8_t> is_inside, glm::ivec3 first)
{
    int inside = 0;
    for (int corner = 0; corner < 8; ++corner)
        inside +=
            is_inside[grid.index_of(first + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))];
    return inside > 0 && inside < 8;
}

/// Cells whose values are to be found.
struct FittedCells {
    std::vector<std::size_t> cells;
    std::vector<std::uint32_t> number;  ///< one per cell of the grid, into `cells`; or kNotFitted
};

FittedCells cells_of(std::span<const CellBlend> blends, std::span<const std::uint8_t> is_inside)
{
    FittedCells fitted;
    fitted.number.assign(is_inside.size(), kNotFitted);
    for (const CellBlend& blend : blends) {
        for (const std::size_t cell : blend.cells) {
            if (is_inside[cell] == 0 || fitted.number[cell] != kNotFitted)
                continue;
            fitted.number[cell] = static_cast<std::uint32_t>(fitted.cells.size());
            fitted.cells.push_back(cell);
        }
    }
    return fitted;
}

NormalEquations equations_of(std::span<const CellBlend> blends, const FittedCells& fitted)
{
    std::vector<std::map<std::uint32_t, float>> rows(fitted.cells.size());
    for (std::uint32_t row = 0; row < rows.size(); ++row)
        rows[row][row] = kOwnWeight;
    for (const auto& [cells, weights] : blends) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const std::uint32_t row = fitted.number[cells[i]];
            for (std::size_t j = 0; row != kNotFitted && j < cells.size(); ++j) {
                const std::uint32_t column = fitted.number[cells[j]];
                if (column != kNotFitted)
                    rows[row][column] += weights[i] * weights[j];
            }
        }
    }
    NormalEquations equations;
    const auto end_row = [&] {
        equations.begin.push_back(static_cast<std::uint32_t>(equations.columns.size()));
    };
    end_row();
    for (const auto& row : rows) {
        for (const auto& [column, value] : row) {
            equations.columns.push_back(column);
            equations.values.push_back(value);
        }
        end_row();
    }
    return equations;
}

}  // namespace

std::vector<glm::dvec3> places_beside(const AoGrid& grid, std::span<const std::uint8_t> is_inside)
{
    std::vector<glm::dvec3> places;
    for (int z = 0; z + 1 < grid.cells.z; ++z)
        for (int y = 0; y + 1 < grid.cells.y; ++y)
            for (int x = 0; x + 1 < grid.cells.x; ++x) {
                const glm::ivec3 first(x, y, z);
                for (int k = 0; k < kPlacesACube && is_cut(grid, is_inside, first); ++k)
                    places.push_back(
                        place_of(grid, glm::vec3(first) + in_unit_cube(places.size())));
            }
    return places;
}

void fit_inside(AoGrid& grid, std::span<const std::uint8_t> is_inside,
                std::span<const glm::dvec3> places, std::span<const float> values)
{
    std::vector<CellBlend> blends;
    for (const glm::dvec3 place : places)
        blends.push_back(blend_at(grid, place));
    const FittedCells fitted = cells_of(blends, is_inside);
    if (fitted.cells.empty())
        return;
    const NormalEquations equations = equations_of(blends, fitted);
    const std::size_t channels = channels_of(grid.store);
    for (std::size_t first = 0; first < channels; first += 4) {
        const std::size_t count = std::min<std::size_t>(4, channels - first);
        const auto four = [&](const float* of) {
            Eigen::Array4f result = Eigen::Array4f::Zero();
            for (std::size_t c = 0; c < count; ++c)
                result[static_cast<Eigen::Index>(c)] = of[first + c];
            return result;
        };
        FourColumns found, right;
        for (const std::size_t cell : fitted.cells) {
            found.push_back(four(&grid.values[cell * channels]));
            right.push_back(kOwnWeight * found.back());
        }
        for (std::size_t p = 0; p < places.size(); ++p) {
            const auto& [cells, weights] = blends[p];
            Eigen::Array4f rest = four(&values[p * channels]);
            for (std::size_t i = 0; i < cells.size(); ++i) {
                if (fitted.number[cells[i]] == kNotFitted)
                    rest -= weights[i] * four(&grid.values[cells[i] * channels]);
            }
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const std::uint32_t row = fitted.number[cells[i]];
                if (row != kNotFitted)
                    right[row] += weights[i] * rest;
            }
        }
        conjugate_gradients(equations, right, kFitTolerance, kMostFitSteps, found);
        for (std::size_t u = 0; u < found.size(); ++u)
            for (std::size_t c = 0; c < count; ++c)
                grid.values[fitted.cells[u] * channels + first + c] =
                    found[u][static_cast<Eigen::Index>(c)];
    }
    for (const std::size_t cell : fitted.cells) {
        float& alpha = grid.values[cell * channels + 3];
        if (grid.store == GridStore::cone)
            alpha = std::clamp(alpha, 0.0f, 1.0f);
    }
}

}  // namespace surfelao
