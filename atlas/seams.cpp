#include "atlas/seams.h"

#include "surfels/conjugate_gradients.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/sparse_rows.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

/// Triangles that a walk through a chart crosses at most: more than there are in a few texels.
constexpr int kMostSteps = 64;
/// Rounding of a share of a triangle.
constexpr double kLeastShare = -1e-9;
constexpr std::size_t kSeamGrain = 256;  // seams of one task
constexpr GradientLimits kStitchLimits{.residual = 1e-3, .steps = 40};

double cross(glm::dvec2 a, glm::dvec2 b)
{
    return a.x * b.y - a.y * b.x;
}

/// Where the corners of a triangle lie.
struct PlacedTriangle {
    std::uint32_t page = 0;
    glm::dvec2 corners[3];
};

/// Nothing where a corner has no place.
std::optional<PlacedTriangle> placed(const Geometry& geometry, const MapLayout& layout,
                                     std::uint32_t triangle)
{
    constexpr glm::vec2 kCorners[3] = {{0, 0}, {1, 0}, {0, 1}};
    for (std::uint32_t page = 0; page < layout.pages.size(); ++page) {
        PlacedTriangle place{.page = page, .corners = {}};
        int count = 0;
        for (; count < 3; ++count) {
            const auto uv = uv_at(geometry, layout.pages[page], {triangle, kCorners[count]});
            if (!uv)
                break;
            place.corners[count] = *uv;
        }
        if (count == 3)
            return place;
    }
    return {};
}

SeamSide seam_side(const PlacedTriangle& place, const EdgeSide& side)
{
    const std::uint32_t first = side.side() % 3, second = (first + 1) % 3;
    const std::uint32_t low = side.rises() ? first : second, high = side.rises() ? second : first;
    return {place.page, side.triangle(), {low, high}, {place.corners[low], place.corners[high]}};
}

bool is_smooth(const Mesh& mesh, const SeamSide& a, const SeamSide& b)
{
    const std::vector<glm::uvec3>& corners = mesh.surface.corners(mesh.geometry);
    const auto normal = [&](const SeamSide& side, int end) {
        const std::uint32_t wedge = corners[side.triangle][static_cast<int>(side.corners[end])];
        return mesh.surface.normals[wedge];
    };
    return glm::dot(normal(a, 0), normal(b, 0)) >= kSmoothSeam &&
           glm::dot(normal(a, 1), normal(b, 1)) >= kSmoothSeam;
}

/// Whether one gets from a triangle, beyond its side `entry`, straight to a place within the chart.
bool is_in_chart(const Geometry& geometry, const MapLayout& layout, const Seams& seams, Side entry,
                 glm::dvec2 place)
{
    for (int step = 0; step < kMostSteps; ++step) {
        const PlacedTriangle at = *placed(geometry, layout, entry / 3);
        const auto& p = at.corners;
        const double twice = cross(p[1] - p[0], p[2] - p[0]);
        if (twice == 0.0)
            return false;
        std::uint32_t exit = 3;
        double least = kLeastShare;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const double share = cross(p[(k + 1) % 3] - p[k], place - p[k]) / twice;
            if (share < least) {
                least = share;
                exit = k;
            }
        }
        if (exit == 3)
            return true;
        const Side next = seams.beside[entry - entry % 3 + exit];
        if (entry % 3 == exit || next == Seams::kNone)
            return false;
        // a chart may go on whole maps away
        place += placed(geometry, layout, next / 3)->corners[next % 3] - p[(exit + 1) % 3];
        entry = next;
    }
    return false;
}

/// How the surface lies on the page along a side of a triangle.
struct SideFrame {
    glm::dvec2 origin{0.0};  ///< end 0
    glm::dvec2 along{0.0};   ///< from end 0 to end 1
    glm::dvec2 inward{0.0};  ///< to what is one diagonal from the edge
};

SideFrame frame_of(const Geometry& geometry, const MapLayout& layout, const SeamSide& side)
{
    const auto position = [&](std::uint32_t corner) {
        return glm::dvec3(
            geometry.positions[geometry.triangles[side.triangle][static_cast<int>(corner)]]);
    };
    const std::uint32_t third = 3 - side.corners[0] - side.corners[1];
    const glm::dvec3 origin = position(side.corners[0]);
    const glm::dvec3 edge = position(side.corners[1]) - origin, up = position(third) - origin;
    const double share = glm::dot(up, edge) / glm::dot(edge, edge);
    const glm::dvec2 along = side.ends[1] - side.ends[0];
    const glm::dvec2 apex = placed(geometry, layout, side.triangle)->corners[third];
    return {side.ends[0], along,
            (apex - side.ends[0] - share * along) / glm::length(up - share * edge)};
}

/// Which claim of a texel counts: the lowest. The squared distance from the seam in texels, as the
/// bits of a float, and behind it the seam and its side.
using ClaimRank = std::uint64_t;
constexpr ClaimRank kNoClaim = ~ClaimRank{0};

/// A texel beyond a seam and where the other side shows it.
struct Claim {
    std::size_t texel = 0;
    ClaimRank rank = kNoClaim;
    glm::dvec2 place{0.0};
};

/// Of each texel of a page; any number of threads.
using BestClaims = std::vector<std::atomic<ClaimRank>>;

/// Whether this one is better than all before it.
bool takes(std::atomic<ClaimRank>& best, ClaimRank rank)
{
    ClaimRank before = best.load(std::memory_order_relaxed);
    while (rank < before)
        if (best.compare_exchange_weak(before, rank, std::memory_order_relaxed))
            return true;
    return false;
}

/// Finds the claims of seams. Any number of threads.
class ClaimFinder {
public:
    ClaimFinder(const Mesh& mesh, const MapLayout& layout, const Seams& seams, std::uint32_t rings,
                std::span<const std::vector<std::uint8_t>> known)
        : geometry_(mesh.geometry), layout_(layout), seams_(seams), reach_(rings), known_(known)
    {
    }

    /// Those beyond one side of a seam that are the best so far.
    void find(std::size_t seam, int near, BestClaims& best, std::vector<Claim>& claims) const
    {
        const Seam& at = seams_.list[seam];
        const SeamSide &side = at.sides[near], &other = at.sides[1 - near];
        const glm::dvec2 scale(layout_.size.width, layout_.size.height);
        const SideFrame from = frame_of(geometry_, layout_, side);
        const SideFrame to = frame_of(geometry_, layout_, other);
        const glm::dvec2 origin = scale * from.origin, along = scale * from.along;
        const glm::dvec2 inward = scale * from.inward;
        const double whole = cross(along, inward);
        if (whole == 0.0)
            return;
        const std::uint32_t first = other.corners[0], second = other.corners[1];
        const Side entry = 3 * other.triangle + ((first + 1) % 3 == second ? first : second);
        for_each_texel_near(origin, along, [&](std::int64_t x, std::int64_t y) {
            const std::size_t texel =
                std::size_t{folded(y, layout_.size.height)} * layout_.size.width +
                folded(x, layout_.size.width);
            if (known_[side.page][texel] != 0)
                return;
            const glm::dvec2 offset =
                glm::dvec2(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5) - origin;
            const double beyond = cross(offset, along) / whole;  // diagonals
            const double on_edge =
                std::clamp(glm::dot(offset, along) / glm::dot(along, along), 0.0, 1.0);
            const glm::dvec2 nearest = offset - on_edge * along;
            const double distance = glm::dot(nearest, nearest);
            if (beyond <= 0.0 || distance > reach_ * reach_)
                return;
            const ClaimRank rank =
                ClaimRank{std::bit_cast<std::uint32_t>(static_cast<float>(distance))} << 32 |
                (2 * seam + static_cast<std::size_t>(near));
            if (rank >= best[texel].load(std::memory_order_relaxed))
                return;
            const glm::dvec2 place =
                to.origin + cross(offset, inward) / whole * to.along + beyond * to.inward;
            if (at.is_smooth && !(is_in_chart(geometry_, layout_, seams_, entry, place) &&
                                  is_known(other.page, place)))
                return;
            if (takes(best[texel], rank))
                claims.push_back({texel, rank, place});
        });
    }

private:
    static std::uint32_t folded(std::int64_t texel, std::uint32_t side)
    {
        const std::int64_t rest = texel % side;
        return static_cast<std::uint32_t>(rest < 0 ? rest + side : rest);
    }

    /// Row by row those around the edge, and few others.
    template <class Visit>
    void for_each_texel_near(glm::dvec2 origin, glm::dvec2 along, const Visit& visit) const
    {
        const auto texel = [](double place) {
            return static_cast<std::int64_t>(std::floor(place));
        };
        const double low = std::min(0.0, along.y), high = std::max(0.0, along.y);
        for (std::int64_t y = texel(origin.y + low - reach_); y <= texel(origin.y + high + reach_);
             ++y) {
            const double row = static_cast<double>(y) + 0.5 - origin.y;
            double begin = 0.0, end = 1.0;  // the part of the edge within reach of the row
            if (along.y != 0.0) {
                const double a = (row - reach_) / along.y, b = (row + reach_) / along.y;
                begin = std::clamp(std::min(a, b), 0.0, 1.0);
                end = std::clamp(std::max(a, b), 0.0, 1.0);
            }
            const double left = std::min(begin * along.x, end * along.x) - reach_;
            const double right = std::max(begin * along.x, end * along.x) + reach_;
            for (std::int64_t x = texel(origin.x + left); x <= texel(origin.x + right); ++x)
                visit(x, y);
        }
    }

    [[nodiscard]] bool is_known(std::uint32_t page, glm::dvec2 place) const
    {
        const Footprint print = footprint(layout_.size.width, layout_.size.height, place);
        for (int k = 0; k < 4; ++k)
            if (print.weights[k] > 0.0 && known_[page][print.texels[k]] == 0)
                return false;
        return true;
    }

    const Geometry& geometry_;
    const MapLayout& layout_;
    const Seams& seams_;
    double reach_;  // texels
    std::span<const std::vector<std::uint8_t>> known_;
};

/// The best claim of each texel of a page that has any.
std::vector<Claim> best_claims(const ClaimFinder& finder, const std::vector<Seam>& seams,
                               std::uint32_t page, std::size_t texels)
{
    BestClaims best(texels);
    for_all(texels, [&](std::size_t texel) { best[texel] = kNoClaim; });
    std::vector<std::vector<Claim>> found((seams.size() + kSeamGrain - 1) / kSeamGrain);
    for_tasks(found.size(), [&](std::size_t part) {
        const std::size_t end = std::min(seams.size(), kSeamGrain * (part + 1));
        for (std::size_t seam = kSeamGrain * part; seam < end; ++seam)
            for (const int near : {0, 1})
                if (seams[seam].sides[near].page == page)
                    finder.find(seam, near, best, found[part]);
        std::erase_if(found[part],
                      [&](const Claim& claim) { return best[claim.texel] != claim.rank; });
    });
    std::vector<Claim> claims;
    for (const std::vector<Claim>& some : found)
        std::ranges::copy_if(some, std::back_inserter(claims),
                             [&](const Claim& claim) { return best[claim.texel] == claim.rank; });
    return claims;
}

/// Samples of smooth seams: what each shows on one side less what it shows on the other is a sum
/// over few texels of all pages, four on each side.
constexpr std::size_t kFetched = 8;
using SeamSamples = SparseRows<kFetched>;

SeamSamples samples_of(const Seams& seams, std::span<const Map> pages)
{
    const std::uint32_t width = pages[0].width, height = pages[0].height;
    const glm::dvec2 scale(width, height);
    std::vector<std::size_t> firsts{0};  // of each seam's samples
    for (const Seam& seam : seams.list) {
        double length = 0.0;
        for (const SeamSide& side : seam.sides)
            length = std::max(length, glm::length(scale * (side.ends[1] - side.ends[0])));
        firsts.push_back(
            firsts.back() +
            (seam.is_smooth ? static_cast<std::size_t>(std::ceil(kSeamSamples * length)) : 0));
    }
    std::vector<SeamSamples::Entry> entries(kFetched * firsts.back());
    for_all(seams.list.size(), kSeamGrain, [&](std::size_t number) {
        const auto count = static_cast<double>(firsts[number + 1] - firsts[number]);
        for (std::size_t s = firsts[number]; s < firsts[number + 1]; ++s) {
            const double at = (static_cast<double>(s - firsts[number]) + 0.5) / count;
            SeamSamples::Entry* entry = &entries[kFetched * s];
            double sign = 1.0;
            for (const SeamSide& side : seams.list[number].sides) {
                const Footprint print =
                    footprint(width, height, glm::mix(side.ends[0], side.ends[1], at));
                for (int k = 0; k < 4; ++k)
                    *entry++ = {side.page * pages[0].texels() + print.texels[k],
                                sign * print.weights[k]};
                sign = -1.0;
            }
        }
    });
    return {entries, pages.size() * pages[0].texels()};
}

/// How much each sample counts: Cauchy's weights (seams.h: kStitchJump).
std::vector<double> stitch_weights(const std::vector<double>& jumps)
{
    std::vector<double> weights;
    weights.reserve(jumps.size());
    for (const double jump : jumps)
        weights.push_back(1.0 / (1.0 + jump * jump / (kStitchJump * kStitchJump)));
    return weights;
}

/// The change y of values x0 that minimises |W (S (x0 + y))|^2 + kStitchWeight |y|^2, S: the
/// differences, W^2: the weights.
std::vector<double> change_to_join(const SeamSamples& samples, const std::vector<double>& values,
                                   const Progress& progress)
{
    const std::vector<double> weights = stitch_weights(samples.times(values));
    const auto normal_product = [&](const std::vector<double>& of) {
        std::vector<double> differences = samples.times(of);
        for (std::size_t s = 0; s < weights.size(); ++s)
            differences[s] *= weights[s];
        return samples.transposed_times(differences);
    };
    std::vector<double> right = normal_product(values);
    for (double& value : right)
        value = -value;
    std::vector<double> diagonal = samples.squares(weights);
    for (double& value : diagonal)
        value += kStitchWeight;
    return conjugate_gradients(
        [&](const std::vector<double>& of) {
            std::vector<double> image = normal_product(of);
            for (std::size_t k = 0; k < image.size(); ++k)
                image[k] += kStitchWeight * of[k];
            return image;
        },
        diagonal, std::move(right), kStitchLimits, progress);
}

float& value_at(std::span<Map> pages, std::uint64_t texel, std::uint32_t channel)
{
    Map& page = pages[texel / pages[0].texels()];
    return page.values[texel % pages[0].texels() * page.channels + channel];
}

std::vector<double> values_of(const SeamSamples& samples, std::span<const Map> pages,
                              std::uint32_t channel)
{
    std::vector<double> values;
    values.reserve(samples.columns().size());
    for (const std::uint64_t texel : samples.columns()) {
        const Map& page = pages[texel / pages[0].texels()];
        values.push_back(page.values[texel % pages[0].texels() * page.channels + channel]);
    }
    return values;
}

}  // namespace

std::uint64_t Seams::smooth_count() const
{
    return static_cast<std::uint64_t>(
        std::ranges::count_if(list, [](const Seam& seam) { return seam.is_smooth; }));
}

Seams seams_of(const Mesh& mesh, const MapLayout& layout)
{
    Seams seams;
    if (layout.is_blended)
        return seams;
    seams.beside.assign(3 * mesh.geometry.triangles.size(), Seams::kNone);
    Edges(mesh.geometry).for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
        if (sides.size() != 2 || sides[0].rises() == sides[1].rises())
            return;
        const auto first = placed(mesh.geometry, layout, sides[0].triangle());
        const auto second = placed(mesh.geometry, layout, sides[1].triangle());
        if (!first || !second)
            return;
        const SeamSide a = seam_side(*first, sides[0]), b = seam_side(*second, sides[1]);
        const glm::dvec2 offset = b.ends[0] - a.ends[0];
        if (a.page == b.page && offset == glm::round(offset) && b.ends[1] - a.ends[1] == offset) {
            seams.beside[sides[0].side()] = sides[1].side();
            seams.beside[sides[1].side()] = sides[0].side();
        } else {
            seams.list.push_back({{a, b}, is_smooth(mesh, a, b)});
        }
    });
    return seams;
}

void fill_across(const Mesh& mesh, const MapLayout& layout, const Seams& seams, std::uint32_t rings,
                 std::span<Map> pages, std::span<std::vector<std::uint8_t>> known)
{
    SURFELAO_CHECK(pages.size() == layout.pages.size() && known.size() == pages.size());
    const ClaimFinder finder(mesh, layout, seams, rings, known);
    std::vector<std::vector<Claim>> claims(pages.size());
    for (std::uint32_t page = 0; page < pages.size() && !seams.list.empty(); ++page)
        claims[page] = best_claims(finder, seams.list, page, pages[page].texels());
    for (std::size_t to = 0; to < pages.size(); ++to) {
        Map& page = pages[to];
        for (const Claim& claim : claims[to]) {
            const std::size_t side = claim.rank & 0xffffffffu;
            const Seam& seam = seams.list[side / 2];
            if (!seam.is_smooth)
                continue;
            // of which texels alone are taken that were known before
            const Map& other = pages[seam.sides[1 - side % 2].page];
            for (std::uint32_t c = 0; c < page.channels; ++c)
                page.values[claim.texel * page.channels + c] = fetch(other, c, claim.place);
            known[to][claim.texel] = 1;
        }
    }
}

void stitch(const Seams& seams, std::span<Map> pages, const Progress& progress)
{
    if (seams.smooth_count() == 0)
        return;
    const SeamSamples samples = samples_of(seams, pages);
    for (std::uint32_t channel = 0; channel < pages[0].channels; ++channel) {
        const std::vector<double> values = values_of(samples, pages, channel);
        const std::vector<double> change = change_to_join(samples, values, progress);
        const auto [least, most] = std::ranges::minmax(values);
        for (std::size_t k = 0; k < values.size(); ++k)
            value_at(pages, samples.columns()[k], channel) =
                static_cast<float>(std::clamp(values[k] + change[k], least, most));
    }
}

SeamJump seam_jump(const Seams& seams, std::span<const Map> pages)
{
    if (seams.smooth_count() == 0)
        return {};
    const SeamSamples samples = samples_of(seams, pages);
    SeamJump jump;
    const std::vector<double> differences = samples.times(values_of(samples, pages, 0));
    double sum = 0.0;
    for (const double difference : differences) {
        jump.most = std::max(jump.most, std::abs(difference));
        sum += difference * difference;
    }
    jump.rms = std::sqrt(sum / static_cast<double>(differences.size()));
    return jump;
}

}  // namespace surfelao
