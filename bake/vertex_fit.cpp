#include "bake/vertex_fit.h"

#include "surfels/buckets.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

double area_of(const Geometry& geometry, std::size_t triangle)
{
    const glm::uvec3 t = geometry.triangles[triangle];
    const glm::dvec3 a(geometry.positions[t.x]);
    return 0.5 * glm::length(glm::cross(glm::dvec3(geometry.positions[t.y]) - a,
                                        glm::dvec3(geometry.positions[t.z]) - a));
}

void add_samples(std::uint32_t triangle, std::uint32_t rows, std::vector<SurfacePoint>& points)
{
    const float size = 1.0f / static_cast<float>(rows);
    const glm::vec2 shift(kSampleShift[0], kSampleShift[1]);
    const glm::vec2 upright = glm::vec2(1.0f / 3.0f) + shift;
    const glm::vec2 turned = glm::vec2(2.0f / 3.0f) - shift;
    for (std::uint32_t i = 0; i < rows; ++i) {
        for (std::uint32_t j = 0; i + j < rows; ++j) {
            const glm::vec2 corner(static_cast<float>(i), static_cast<float>(j));
            points.push_back({triangle, size * (corner + upright)});
            if (i + j + 1 < rows)
                points.push_back({triangle, size * (corner + turned)});
        }
    }
}

/// Barycentric weight of one corner.
double weight_of(glm::vec2 at, int corner)
{
    return corner == 0 ? 1.0 - at.x - at.y : at[corner - 1];
}

template <class Body>
void in_blocks(std::size_t count, const Body& body)
{
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              body(i);
                      });
}

/// Part of the matrix that one triangle makes: its diagonal, then the entries (0,1) (1,2) (2,0).
using TriangleMatrix = std::array<float, 6>;

}  // namespace

SurfaceSamples fit_samples(const Geometry& geometry)
{
    const std::size_t count = geometry.triangles.size();
    std::vector<double> areas(count);
    in_blocks(count, [&](std::size_t t) { areas[t] = area_of(geometry, t); });
    double area = 0.0;
    for (const double each : areas)
        area += each;
    const auto wanted = static_cast<double>(std::max<std::uint64_t>(kFewestSamples, count));
    SurfaceSamples samples;
    samples.first.reserve(count + 1);
    samples.first.push_back(0);
    samples.points.reserve(count + static_cast<std::size_t>(wanted) / 4);
    for (std::uint32_t t = 0; t < count; ++t) {
        const double rows = std::round(std::sqrt(wanted * areas[t] / area));
        add_samples(t, static_cast<std::uint32_t>(std::clamp(rows, 1.0, double{kMostSampleRows})),
                    samples.points);
        samples.first.push_back(static_cast<std::uint32_t>(samples.points.size()));
    }
    return samples;
}

struct VertexFit::Impl {
    const Geometry& geometry;
    const Surface& surface;
    SurfaceSamples samples;
    std::size_t unknown_count = 0;        ///< found with the next
    std::vector<std::uint32_t> unknowns;  ///< per vertex; kUnused where no triangle uses it
    Buckets<std::uint32_t> corners;  ///< 3 * triangle + corner, by unknown
    Matrix matrix;

    Impl(const Geometry& g, const Surface& s, const NormalSettings& normals, SurfaceSamples places)
        : geometry(g),
          surface(s),
          samples(std::move(places)),
          unknowns(find_unknowns(normals)),
          corners(unknown_count, [&](const auto& put) {
              for (std::uint32_t t = 0; t < g.triangles.size(); ++t) {
                  for (std::uint32_t corner = 0; corner < 3; ++corner)
                      put(unknown_at(t, static_cast<int>(corner)), 3 * t + corner);
              }
          })
    {
        make_matrix();
    }

    std::uint32_t unknown_at(std::size_t triangle, int corner) const
    {
        return unknowns[geometry.triangles[triangle][corner]];
    }

    double sample_area(std::size_t triangle) const
    {
        return area_of(geometry, triangle) /
               (samples.first[triangle + 1] - samples.first[triangle]);
    }

    std::vector<std::uint32_t> find_unknowns(const NormalSettings& normals);
    TriangleMatrix matrix_of(std::size_t triangle) const;
    void make_matrix();
};

std::vector<std::uint32_t> VertexFit::Impl::find_unknowns(const NormalSettings& normals)
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

TriangleMatrix VertexFit::Impl::matrix_of(std::size_t triangle) const
{
    std::array<double, 6> sum{};
    const double area = sample_area(triangle);
    for (std::uint32_t s = samples.first[triangle]; s < samples.first[triangle + 1]; ++s) {
        std::array<double, 3> b;
        for (int corner = 0; corner < 3; ++corner)
            b[static_cast<std::size_t>(corner)] = weight_of(samples.points[s].at, corner);
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += area * b[i] * b[i];
            sum[3 + i] += area * b[i] * b[(i + 1) % 3];
        }
    }
    const double edge = kFitSmoothness * area_of(geometry, triangle) / 3.0;
    TriangleMatrix own;
    for (std::size_t i = 0; i < 3; ++i) {
        own[i] = static_cast<float>(sum[i] + 2.0 * edge);
        own[3 + i] = static_cast<float>(sum[3 + i] - edge);
    }
    return own;
}

void VertexFit::Impl::make_matrix()
{
    std::vector<TriangleMatrix> local(geometry.triangles.size());
    in_blocks(local.size(), [&](std::size_t t) { local[t] = matrix_of(t); });

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
                const TriangleMatrix& m = local[at / 3];
                const std::size_t own = at % 3, after = (own + 1) % 3, before = (own + 2) % 3;
                const auto column = [&](std::size_t corner) {
                    return static_cast<int>(unknown_at(at / 3, static_cast<int>(corner)));
                };
                row.emplace_back(static_cast<int>(unknown), m[own]);
                row.emplace_back(column(after), m[3 + own]);
                row.emplace_back(column(before), m[3 + before]);
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
    for (const Block& block : blocks) {
        for (const int count : block.counts) {
            row_end[1] = row_end[0] + count;
            ++row_end;
        }
        std::ranges::copy(block.columns, matrix.innerIndexPtr() + filled);
        std::ranges::copy(block.values, matrix.valuePtr() + filled);
        filled += static_cast<std::ptrdiff_t>(block.columns.size());
    }
}

VertexFit::VertexFit(const Geometry& geometry, const Surface& surface,
                     const NormalSettings& normals, SurfaceSamples samples)
    : impl_(std::make_unique<Impl>(geometry, surface, normals, std::move(samples)))
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

std::vector<Occlusion> VertexFit::solve(std::span<const Occlusion> answers) const
{
    const Impl& impl = *impl_;
    const auto count = static_cast<std::ptrdiff_t>(impl.unknown_count);
    std::array<Eigen::VectorXd, kChannels> right, solution;
    for (int channel = 0; channel < kChannels; ++channel) {
        right[static_cast<std::size_t>(channel)].resize(count);
        solution[static_cast<std::size_t>(channel)].resize(count);
    }
    in_blocks(impl.unknown_count, [&](std::size_t unknown) {
        glm::dvec4 sum(0.0);
        double weights = 0.0;
        for (const std::uint32_t at : impl.corners[unknown]) {
            const std::uint32_t triangle = at / 3;
            const double area = impl.sample_area(triangle);
            for (std::uint32_t s = impl.samples.first[triangle];
                 s < impl.samples.first[triangle + 1]; ++s) {
                const Occlusion& answer = answers[s];
                const double weight =
                    area * weight_of(impl.samples.points[s].at, static_cast<int>(at % 3));
                sum += weight *
                       glm::dvec4((1.0f - answer.occlusion) * answer.bent_normal, answer.occlusion);
                weights += weight;
            }
        }
        for (int channel = 0; channel < kChannels; ++channel) {
            const auto c = static_cast<std::size_t>(channel);
            right[c][static_cast<std::ptrdiff_t>(unknown)] = sum[channel];
            solution[c][static_cast<std::ptrdiff_t>(unknown)] = sum[channel] / weights;
        }
    });
    tbb::parallel_for(std::size_t{0}, right.size(), [&](std::size_t channel) {
        Solver solver;
        solver.setTolerance(kTolerance);
        solver.setMaxIterations(kMostSteps);
        solver.compute(impl.matrix);
        solution[channel] = solver.solveWithGuess(right[channel], solution[channel]).eval();
    });

    std::vector<Occlusion> values(impl.unknowns.size());
    in_blocks(values.size(), [&](std::size_t v) {
        values[v].bent_normal = impl.surface.normals[v];
        if (impl.unknowns[v] == kUnused)
            return;
        const auto unknown = static_cast<std::ptrdiff_t>(impl.unknowns[v]);
        values[v].occlusion = static_cast<float>(std::clamp(solution[3][unknown], 0.0, 1.0));
        const glm::dvec3 bent(solution[0][unknown], solution[1][unknown], solution[2][unknown]);
        const double length = glm::length(bent);
        if (length > kLeastBent)
            values[v].bent_normal = glm::vec3(bent / length);
    });
    return values;
}

}  // namespace surfelao
