#include "bake/vertex_fit.h"

#include "bake/fit_cells.h"
#include "surfels/buckets.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kGrain = 4096;

/// Of conjugate gradients: residual, as a share of the right side, and steps. The values are then
/// right to some 1e-4.
constexpr double kTolerance = 1e-4;
constexpr int kMostSteps = 100;

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Solver = Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper>;

/// Bent vector and occlusion are four right sides of one matrix.
constexpr int kChannels = 4;

template <class Body>
void in_blocks(std::size_t count, const Body& body)
{
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              body(i);
                      });
}

/// Per vertex; kUnused where no triangle uses it. At each place, vertices whose normals are smooth
/// with those of an earlier one share its unknown.
std::vector<std::uint32_t> unknowns_of(const Geometry& geometry, const Surface& surface,
                                       const NormalSettings& normals, std::size_t& unknown_count)
{
    const std::size_t count = geometry.positions.size();
    std::vector<bool> used(count, false);
    for (const glm::uvec3 t : geometry.triangles)
        used[t.x] = used[t.y] = used[t.z] = true;
    // at each place: the vertices that stand for an unknown, as lists
    std::vector<std::uint32_t> found(count, kUnused), first(count, kUnused), next(count, kUnused);
    for (std::uint32_t v = 0; v < count; ++v) {
        if (!used[v])
            continue;
        std::uint32_t& head = first[geometry.welded[v]];
        std::uint32_t other = head;
        while (other != kUnused && !are_smooth(surface.normals[other], surface.normals[v], normals))
            other = next[other];
        if (other == kUnused) {
            found[v] = static_cast<std::uint32_t>(unknown_count++);
            next[v] = std::exchange(head, v);
        } else {
            found[v] = found[other];
        }
    }
    return found;
}

int corner_count(const FitCell& cell)
{
    return cell.unknowns.w == FitCell::kNoCorner ? 3 : 4;
}

}  // namespace

namespace {

/// Right sides of the normal equations, and values: to begin with the means of the answers around.
struct Channels {
    std::array<Eigen::VectorXd, kChannels> right, values;
};

}  // namespace

struct VertexFit::Impl {
    const Geometry& geometry;
    const Surface& surface;
    std::size_t unknown_count = 0;        ///< found with the next
    std::vector<std::uint32_t> unknowns;  ///< per vertex
    SurfaceSamples samples;
    std::vector<bool> edged;  ///< unknowns of vertices that faces share over a hard edge

    /// Made when they are first asked for: the engines that answer before need the memory.
    struct Equations {
        Buckets<std::uint32_t> corners;  ///< 4 * cell + corner, by unknown
        Matrix matrix;
    };
    mutable std::once_flag are_made;
    mutable std::optional<Equations> made;

    Impl(const Geometry& g, const Surface& s, const NormalSettings& normals)
        : geometry(g),
          surface(s),
          unknowns(unknowns_of(g, s, normals, unknown_count)),
          samples(samples_of(g, unknowns)),
          edged(unknown_count, false)
    {
        for (std::uint32_t wedge = 0; wedge < s.normals.size(); ++wedge) {
            const std::uint32_t vertex = s.vertex_of(wedge);
            if (unknowns[vertex] != kUnused &&
                !are_smooth(s.normals[vertex], s.normals[wedge], normals))
                edged[unknowns[vertex]] = true;
        }
    }

    const Equations& equations() const
    {
        std::call_once(are_made, [&] {
            made.emplace(Equations{corners_of_unknowns(), {}});
            make_matrix(made->corners, made->matrix);
        });
        return *made;
    }

    Buckets<std::uint32_t> corners_of_unknowns() const
    {
        return {unknown_count, [this](const auto& put) {
                    for (std::uint32_t cell = 0; cell + 1 < samples.cells.size(); ++cell) {
                        const FitCell& own = samples.cells[cell];
                        for (int corner = 0; corner < corner_count(own); ++corner)
                            put(own.unknowns[corner],
                                4 * cell + static_cast<std::uint32_t>(corner));
                    }
                }};
    }

    /// Of a sample at the corners of its cell.
    glm::dvec4 weights_of(std::uint32_t sample) const
    {
        if (sample < samples.quad_weights.size())
            return samples.quad_weights[sample];
        const glm::dvec2 at = samples.points[sample].at;
        return {1.0 - at.x - at.y, at.x, at.y, 0.0};
    }

    /// Calls visit(sample) for those of a cell.
    template <class Visit>
    void for_each_sample(std::uint32_t cell, const Visit& visit) const
    {
        for (std::uint32_t s = samples.cells[cell].first_sample;
             s < samples.cells[cell + 1].first_sample; ++s)
            visit(s);
    }

    glm::dvec4 row_of(std::uint32_t cell, int corner) const;
    void make_matrix(const Buckets<std::uint32_t>& corners, Matrix& matrix) const;
    Channels channels_of(std::span<const Occlusion> answers) const;
    std::vector<Occlusion> values_of(const Channels& channels) const;
};

/// What a cell adds to the row of one of its corners: an entry for each corner.
glm::dvec4 VertexFit::Impl::row_of(std::uint32_t cell, int corner) const
{
    glm::dvec4 row(0.0);
    double area = 0.0;
    for_each_sample(cell, [&](std::uint32_t s) {
        const glm::dvec4 weights = weights_of(s);
        row += static_cast<double>(samples.areas[s]) * weights[corner] * weights;
        area += static_cast<double>(samples.areas[s]);
    });
    // edges that meet at the corner: in a quad either cut gives half of its two triangles' edges
    const FitCell& own = samples.cells[cell];
    const int count = corner_count(own);
    bool at_edge = false;
    for (int each = 0; each < count; ++each)
        at_edge |= edged[own.unknowns[each]];
    const double smoothness = at_edge ? kFitSmoothnessAtEdges : kFitSmoothness;
    for (int other = 0; other < count; ++other) {
        if (other == corner)
            continue;
        const double edge = smoothness * area / (count == 3 ? 3.0 : 6.0);
        row[corner] += edge;
        row[other] -= edge;
    }
    return row;
}

void VertexFit::Impl::make_matrix(const Buckets<std::uint32_t>& corners, Matrix& matrix) const
{
    struct Block {
        std::vector<int> counts, columns;  ///< of rows; of entries
        std::vector<double> values;
    };
    const auto size = static_cast<std::ptrdiff_t>(unknown_count);
    std::vector<Block> blocks((unknown_count + kGrain - 1) / kGrain);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t index) {
        Block& block = blocks[index];
        std::vector<std::pair<int, double>> row;
        const std::size_t end = std::min(unknown_count, (index + 1) * kGrain);
        for (std::size_t unknown = index * kGrain; unknown < end; ++unknown) {
            row.clear();
            for (const std::uint32_t at : corners[unknown]) {
                const FitCell& cell = samples.cells[at / 4];
                const glm::dvec4 entries = row_of(at / 4, static_cast<int>(at % 4));
                for (int corner = 0; corner < corner_count(cell); ++corner)
                    row.emplace_back(static_cast<int>(cell.unknowns[corner]), entries[corner]);
            }
            std::ranges::stable_sort(row, {}, &std::pair<int, double>::first);
            const std::size_t filled = block.columns.size();
            for_each_run(
                std::span(row), [](auto& a, auto& b) { return a.first == b.first; },
                [&](auto run) {
                    double sum = 0.0;
                    for (const auto& entry : run)
                        sum += entry.second;
                    block.columns.push_back(run.front().first);
                    block.values.push_back(sum);
                });
            block.counts.push_back(static_cast<int>(block.columns.size() - filled));
        }
    });

    std::ptrdiff_t entries = 0;
    for (const Block& block : blocks)
        entries += static_cast<std::ptrdiff_t>(block.columns.size());
    matrix.resize(size, size);
    matrix.resizeNonZeros(entries);
    int* row_end = matrix.outerIndexPtr();
    *row_end = 0;
    std::ptrdiff_t filled = 0;
    for (Block& block : blocks) {
        for (const int count : block.counts) {
            row_end[1] = row_end[0] + count;
            ++row_end;
        }
        std::ranges::copy(block.columns, matrix.innerIndexPtr() + filled);
        std::ranges::copy(block.values, matrix.valuePtr() + filled);
        filled += static_cast<std::ptrdiff_t>(block.columns.size());
        block = {};
    }
}

VertexFit::VertexFit(const Geometry& geometry, const Surface& surface,
                     const NormalSettings& normals)
    : impl_(std::make_unique<Impl>(geometry, surface, normals))
{
}
VertexFit::~VertexFit() = default;
VertexFit::VertexFit(VertexFit&&) noexcept = default;
VertexFit& VertexFit::operator=(VertexFit&&) noexcept = default;

const SurfaceSamples& VertexFit::samples() const
{
    return impl_->samples;
}

std::vector<std::uint32_t> VertexFit::unused_vertices() const
{
    std::vector<std::uint32_t> unused;
    for (std::uint32_t v = 0; v < impl_->unknowns.size(); ++v) {
        if (impl_->unknowns[v] == kUnused)
            unused.push_back(v);
    }
    return unused;
}

Channels VertexFit::Impl::channels_of(std::span<const Occlusion> answers) const
{
    const auto count = static_cast<std::ptrdiff_t>(unknown_count);
    const Buckets<std::uint32_t>& corners = equations().corners;
    Channels channels;
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
        channels.right[channel].resize(count);
        channels.values[channel].resize(count);
    }
    in_blocks(unknown_count, [&](std::size_t unknown) {
        glm::dvec4 sum(0.0);
        double weights = 0.0;
        for (const std::uint32_t at : corners[unknown]) {
            for_each_sample(at / 4, [&](std::uint32_t s) {
                const Occlusion& answer = answers[s];
                const double weight =
                    static_cast<double>(samples.areas[s]) * weights_of(s)[static_cast<int>(at % 4)];
                sum += weight *
                       glm::dvec4((1.0f - answer.occlusion) * answer.bent_normal, answer.occlusion);
                weights += weight;
            });
        }
        for (int channel = 0; channel < kChannels; ++channel) {
            const auto c = static_cast<std::size_t>(channel);
            channels.right[c][static_cast<std::ptrdiff_t>(unknown)] = sum[channel];
            channels.values[c][static_cast<std::ptrdiff_t>(unknown)] = sum[channel] / weights;
        }
    });
    return channels;
}

std::vector<Occlusion> VertexFit::Impl::values_of(const Channels& channels) const
{
    const auto& solution = channels.values;
    std::vector<Occlusion> values(unknowns.size());
    in_blocks(values.size(), [&](std::size_t v) {
        values[v].bent_normal = surface.normals[v];
        if (unknowns[v] == kUnused)
            return;
        const auto unknown = static_cast<std::ptrdiff_t>(unknowns[v]);
        values[v].occlusion = static_cast<float>(std::clamp(solution[3][unknown], 0.0, 1.0));
        const glm::dvec3 bent(solution[0][unknown], solution[1][unknown], solution[2][unknown]);
        const double length = glm::length(bent);
        if (length > kLeastBent)
            values[v].bent_normal = glm::vec3(bent / length);
    });
    return values;
}

std::vector<Occlusion> VertexFit::solve(std::span<const Occlusion> answers) const
{
    Channels channels = impl_->channels_of(answers);
    const Matrix& matrix = impl_->equations().matrix;
    tbb::parallel_for(std::size_t{0}, channels.right.size(), [&](std::size_t channel) {
        Solver solver;
        solver.setTolerance(kTolerance);
        solver.setMaxIterations(kMostSteps);
        solver.compute(matrix);
        channels.values[channel] =
            solver.solveWithGuess(channels.right[channel], channels.values[channel]).eval();
    });
    return impl_->values_of(channels);
}

std::vector<Occlusion> VertexFit::solve_locally(std::span<const Occlusion> answers) const
{
    Channels channels = impl_->channels_of(answers);
    const Matrix& matrix = impl_->equations().matrix;
    const Eigen::VectorXd inverse = matrix.diagonal().cwiseInverse();
    // rows over their diagonal: the sums of their entries bound all eigenvalues (Gershgorin)
    double largest = 0.0;
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        double sum = 0.0;
        for (Matrix::InnerIterator entry(matrix, row); entry; ++entry)
            sum += std::abs(entry.value());
        largest = std::max(largest, sum * inverse[row]);
    }
    const double middle = 0.5 * largest * (1.0 + kLocalSpectrum);
    const double half = 0.5 * largest * (1.0 - kLocalSpectrum);
    tbb::parallel_for(std::size_t{0}, channels.right.size(), [&](std::size_t channel) {
        Eigen::VectorXd& x = channels.values[channel];
        Eigen::VectorXd rest = channels.right[channel] - matrix * x;
        Eigen::VectorXd step = inverse.cwiseProduct(rest) / middle;
        double rho = half / middle;
        for (int i = 1;; ++i) {
            x += step;
            if (i == kLocalSteps)
                break;
            rest -= matrix * step;
            const double next = 1.0 / (2.0 * middle / half - rho);
            step = next * rho * step + (2.0 * next / half) * inverse.cwiseProduct(rest);
            rho = next;
        }
    });
    return impl_->values_of(channels);
}

}  // namespace surfelao
