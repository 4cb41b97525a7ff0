#include "bake/vertex_fit.h"

#include "bake/fit_cells.h"
#include "bake/normal_equations.h"
#include "surfels/buckets.h"
#include "surfels/for_all.h"

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

/// The unknowns at the corners of a cell; a triangle has three.
struct Cell {
    glm::uvec4 unknowns{kUnused};
    int corners = 3;
};

}  // namespace

namespace {

/// Bent vector and occlusion: right sides of the normal equations, and values: to begin with the
/// means of the answers around.
struct Channels {
    FourColumns right, values;
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
        NormalEquations matrix;
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
                    for (std::uint32_t cell = 0; cell + 1 < samples.first_sample.size(); ++cell) {
                        const Cell own = cell_at(cell);
                        for (int corner = 0; corner < own.corners; ++corner)
                            put(own.unknowns[corner],
                                4 * cell + static_cast<std::uint32_t>(corner));
                    }
                }};
    }

    Cell cell_at(std::uint32_t cell) const
    {
        if (cell < samples.quads.size())
            return {samples.quads[cell], 4};
        const glm::uvec3 t =
            geometry.triangles[samples.points[samples.first_sample[cell]].triangle];
        return {{unknowns[t.x], unknowns[t.y], unknowns[t.z], kUnused}, 3};
    }

    /// Of a sample at the corners of its cell.
    glm::dvec4 weights_of(std::uint32_t sample) const
    {
        if (sample < samples.quad_weights.size())
            return samples.quad_weights[sample];
        const glm::dvec2 at = samples.points[sample].at;
        return {1.0 - at.x - at.y, at.x, at.y, 0.0};
    }

    float weight_of(std::uint32_t sample, std::uint32_t corner) const
    {
        if (sample < samples.quad_weights.size())
            return samples.quad_weights[sample][static_cast<int>(corner)];
        const glm::vec2 at = samples.points[sample].at;
        return corner == 0 ? 1.0f - at.x - at.y : corner == 1 ? at.x : at.y;
    }

    /// Calls visit(sample) for those of a cell.
    template <class Visit>
    void for_each_sample(std::uint32_t cell, const Visit& visit) const
    {
        for (std::uint32_t s = samples.first_sample[cell]; s < samples.first_sample[cell + 1]; ++s)
            visit(s);
    }

    glm::dvec4 row_of(std::uint32_t cell, const Cell& own, int corner) const;
    void make_matrix(const Buckets<std::uint32_t>& corners, NormalEquations& matrix) const;
    Channels channels_of(std::span<const Occlusion> answers) const;
    std::vector<Occlusion> values_of(const Channels& channels) const;
};

/// What a cell adds to the row of one of its corners: an entry for each corner.
glm::dvec4 VertexFit::Impl::row_of(std::uint32_t cell, const Cell& own, int corner) const
{
    glm::dvec4 row(0.0);
    double area = 0.0;
    for_each_sample(cell, [&](std::uint32_t s) {
        const glm::dvec4 weights = weights_of(s);
        row += static_cast<double>(samples.areas[s]) * weights[corner] * weights;
        area += static_cast<double>(samples.areas[s]);
    });
    // edges that meet at the corner: in a quad either cut gives half of its two triangles' edges
    const int count = own.corners;
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

void VertexFit::Impl::make_matrix(const Buckets<std::uint32_t>& corners,
                                  NormalEquations& matrix) const
{
    struct Block {
        std::vector<std::uint32_t> counts, columns;  ///< of rows; of entries
        std::vector<float> values;
    };
    using Entry = std::pair<std::uint32_t, double>;
    std::vector<Block> blocks((unknown_count + kGrain - 1) / kGrain);
    for_tasks(blocks.size(), [&](std::size_t index) {
        Block& block = blocks[index];
        std::vector<Entry> row;
        const std::size_t end = std::min(unknown_count, (index + 1) * kGrain);
        for (std::size_t unknown = index * kGrain; unknown < end; ++unknown) {
            row.clear();
            for (const std::uint32_t at : corners[unknown]) {
                const Cell cell = cell_at(at / 4);
                const glm::dvec4 entries = row_of(at / 4, cell, static_cast<int>(at % 4));
                for (int corner = 0; corner < cell.corners; ++corner)
                    row.emplace_back(cell.unknowns[corner], entries[corner]);
            }
            std::ranges::stable_sort(row, {}, &Entry::first);
            const std::size_t filled = block.columns.size();
            for_each_run(
                std::span(row), [](auto& a, auto& b) { return a.first == b.first; },
                [&](auto run) {
                    double sum = 0.0;
                    for (const auto& entry : run)
                        sum += entry.second;
                    block.columns.push_back(run.front().first);
                    block.values.push_back(static_cast<float>(sum));
                });
            block.counts.push_back(static_cast<std::uint32_t>(block.columns.size() - filled));
        }
    });

    std::size_t entries = 0;
    for (const Block& block : blocks)
        entries += block.columns.size();
    matrix.begin.reserve(unknown_count + 1);
    matrix.begin.push_back(0);
    matrix.columns.reserve(entries);
    matrix.values.reserve(entries);
    for (Block& block : blocks) {
        for (const std::uint32_t count : block.counts)
            matrix.begin.push_back(matrix.begin.back() + count);
        matrix.columns.insert(matrix.columns.end(), block.columns.begin(), block.columns.end());
        matrix.values.insert(matrix.values.end(), block.values.begin(), block.values.end());
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

void VertexFit::fold(std::size_t first, std::size_t end)
{
    drop_triangles(impl_->samples, first, end);
}

void VertexFit::unfold()
{
    add_triangles(triangle_areas(impl_->geometry), impl_->samples);
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
    const Buckets<std::uint32_t>& corners = equations().corners;
    Channels channels{FourColumns(unknown_count), FourColumns(unknown_count)};
    for_all(unknown_count, [&](std::size_t unknown) {
        Eigen::Array4f sum = Eigen::Array4f::Zero();
        float weights = 0.0f;
        for (const std::uint32_t at : corners[unknown]) {
            for_each_sample(at / 4, [&](std::uint32_t s) {
                const Occlusion& answer = answers[s];
                const glm::vec3 bent = (1.0f - answer.occlusion) * answer.bent_normal;
                const float weight = samples.areas[s] * weight_of(s, at % 4);
                sum += weight * Eigen::Array4f(bent.x, bent.y, bent.z, answer.occlusion);
                weights += weight;
            });
        }
        channels.right[unknown] = sum;
        channels.values[unknown] = sum / std::max(weights, std::numeric_limits<float>::min());
    });
    return channels;
}

std::vector<Occlusion> VertexFit::Impl::values_of(const Channels& channels) const
{
    std::vector<Occlusion> values(unknowns.size());
    for_all(values.size(), [&](std::size_t v) {
        values[v].bent_normal = surface.normals[v];
        if (unknowns[v] == kUnused)
            return;
        const Eigen::Array4f& value = channels.values[unknowns[v]];
        values[v].occlusion = std::clamp(value[3], 0.0f, 1.0f);
        const glm::vec3 bent(value[0], value[1], value[2]);
        const float length = glm::length(bent);
        if (length > kLeastBent)
            values[v].bent_normal = bent / length;
    });
    return values;
}

std::vector<Occlusion> VertexFit::solve(std::span<const Occlusion> answers) const
{
    Channels channels = impl_->channels_of(answers);
    conjugate_gradients(impl_->equations().matrix, channels.right, kTolerance, kMostSteps,
                        channels.values);
    return impl_->values_of(channels);
}

std::vector<Occlusion> VertexFit::solve_locally(std::span<const Occlusion> answers) const
{
    Channels channels = impl_->channels_of(answers);
    chebyshev(impl_->equations().matrix, channels.right, kLocalSteps, kLocalSpectrum,
              channels.values);
    return impl_->values_of(channels);
}

}  // namespace surfelao
