#include "bake/subdivide.h"

#include "bake/subdivide_piece.h"
#include "surfels/errors.h"

#include <tbb/parallel_sort.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// Two numbers without an order, as one.
std::uint64_t pair_of(std::uint32_t a, std::uint32_t b)
{
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// An edge of a piece whose middle is asked.
struct AskedSide {
    std::uint64_t edge = 0;      ///< the welded vertices at its ends
    std::uint64_t vertices = 0;  ///< those of the piece
    std::uint32_t piece = 0;
    std::uint32_t corner = 0;  ///< behind which it lies
    auto operator<=>(const AskedSide&) const = default;
};

/// Asked once; belongs to the piece around it.
struct Probe {
    std::uint32_t piece = 0;
    std::uint32_t triangle = 0;  ///< of the geometry
    glm::vec2 place{0.0f};       ///< as Place
    float answer = 0.0f;
};

int next(int corner)
{
    return (corner + 1) % 3;
}

class Subdivider {
public:
    Subdivider(const Mesh& mesh, double tolerance, const Offset& offset, const Ask& ask,
               const Progress& progress)
        : mesh_(mesh),
          tolerance_(static_cast<float>(tolerance)),
          offset_(offset),
          ask_(ask),
          progress_(progress),
          positions_(mesh.geometry.positions),
          welded_(mesh.geometry.welded)
    {
        const std::size_t count = mesh.scene.triangles.size();
        in_geometry_.assign(count, kNowhere);
        for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t)
            in_geometry_[mesh.geometry.scene_triangle(t)] = t;
        pieces_.reserve(count);
        for (const glm::uvec3& triangle : mesh.scene.triangles)
            pieces_.push_back({triangle, {Place(0), Place(kPlaceUnit, 0), Place(0, kPlaceUnit)}});
        old_of_.resize(count);
        std::iota(old_of_.begin(), old_of_.end(), 0u);
    }

    Subdivision run()
    {
        ask_vertices();
        ask_probes();
        for (int round = 0; round < kMostRounds; ++round) {
            begin_round(round);
            cut_edges_.clear();
            middles_.clear();
            force_by_probes();
            ask_sides(sides_to_ask());
            if (cut_edges_.empty())
                break;
            force_longest();
            ask_sides(sides_to_ask());
            add_vertices();
            cut_pieces();
            ++result_.rounds;
        }
        Refinement& refinement = result_.refinement;
        refinement.old_vertices = static_cast<std::uint32_t>(mesh_.scene.positions.size());
        refinement.parents = std::move(parents_);
        for (std::uint32_t p = 0; p < pieces_.size(); ++p) {
            if (refinement.first.size() == old_of_[p])
                refinement.first.push_back(p);
            refinement.pieces.push_back(pieces_[p].vertices);
        }
        refinement.first.push_back(static_cast<std::uint32_t>(pieces_.size()));
        return std::move(result_);
    }

private:
    /// Nobody knows how many rounds there will be: each is half of what is left.
    void begin_round(int round)
    {
        done_ = 1.0 - std::ldexp(1.0, -round);
        if (progress_ && !progress_(done_))
            throw Cancelled();
    }

    std::vector<Occlusion> ask(std::span<const Receiver> receivers)
    {
        result_.asked += receivers.size();
        const double begin = done_, part = 0.5 * (1.0 - done_);
        return ask_(receivers, progress_ ? Progress([&, begin, part](double share) {
                        return progress_(begin + part * share);
                    })
                                         : Progress());
    }

    /// What each vertex of the file would hold.
    void ask_vertices()
    {
        const std::vector<Receiver> wedges =
            receivers_at_wedges(mesh_.geometry, mesh_.surface, offset_);
        const std::vector<Occlusion> answers = ask(wedges);
        const std::vector<float> angles = angles_of_wedges(mesh_.geometry, mesh_.surface);
        std::vector<double> sums(positions_.size(), 0.0), weights(positions_.size(), 0.0);
        for (std::uint32_t wedge = 0; wedge < answers.size(); ++wedge) {
            const std::uint32_t vertex = mesh_.surface.vertex_of(wedge);
            sums[vertex] += double{angles[wedge]} * answers[wedge].occlusion;
            weights[vertex] += angles[wedge];
        }
        values_.resize(positions_.size());
        for (std::size_t v = 0; v < values_.size(); ++v)
            values_[v] = weights[v] > 0.0 ? static_cast<float>(sums[v] / weights[v]) : 0.0f;
    }

    void ask_probes()
    {
        const std::vector<double> areas = triangle_areas(mesh_.geometry);
        std::vector<SurfacePoint> points;
        for (std::uint32_t t = 0; t < areas.size(); ++t) {
            if (areas[t] < kProbedArea)
                continue;
            // the middles of rows^2 equal triangles, those upright and those that stand on a corner
            const auto rows = static_cast<int>(std::sqrt(areas[t] / kProbeArea));
            const float size = static_cast<float>(kPlaceUnit) / static_cast<float>(rows);
            for (int row = 0; row < rows; ++row) {
                for (int i = 0; i < 2 * (rows - row) - 1; ++i) {
                    const float inset = i % 2 == 0 ? 1.0f / 3.0f : 2.0f / 3.0f;
                    const glm::vec2 place = size * glm::vec2(static_cast<float>(i / 2) + inset,
                                                             static_cast<float>(row) + inset);
                    const auto piece = static_cast<std::uint32_t>(mesh_.geometry.scene_triangle(t));
                    probes_.push_back({piece, t, place});
                    points.push_back({t, weights_at(place)});
                }
            }
        }
        const std::vector<Occlusion> answers =
            ask(receivers_at(mesh_.geometry, mesh_.surface, points, offset_));
        for (std::size_t i = 0; i < probes_.size(); ++i)
            probes_[i].answer = answers[i].occlusion;
    }

    [[nodiscard]] std::uint64_t edge_of(const Piece& piece, int corner) const
    {
        return pair_of(welded_[piece.vertices[corner]], welded_[piece.vertices[next(corner)]]);
    }

    [[nodiscard]] float length_of(const Piece& piece, int corner) const
    {
        return glm::distance(positions_[piece.vertices[corner]],
                             positions_[piece.vertices[next(corner)]]);
    }

    [[nodiscard]] bool is_long(const Piece& piece, int corner) const
    {
        return length_of(piece, corner) >= 2.0f * kShortestEdge;
    }

    /// Edges of the pieces that do not show what a probe in them says.
    void force_by_probes()
    {
        forced_.clear();
        for (const Probe& probe : probes_) {
            const Piece& piece = pieces_[probe.piece];
            const glm::vec3 share = shares(piece, probe.place);
            const glm::vec3 values(values_[piece.vertices.x], values_[piece.vertices.y],
                                   values_[piece.vertices.z]);
            if (std::abs(glm::dot(share, values) - probe.answer) <= tolerance_)
                continue;
            for (int corner = 0; corner < 3; ++corner) {
                if (is_long(piece, corner))
                    forced_.push_back(edge_of(piece, corner));
            }
        }
        std::ranges::sort(forced_);
    }

    [[nodiscard]] int longest_of(const Piece& piece) const
    {
        int longest = 0;
        for (int corner = 1; corner < 3; ++corner) {
            if (length_of(piece, corner) > length_of(piece, longest))
                longest = corner;
        }
        return longest;
    }

    /// A piece with a cut edge is cut at its longest edge too, and so is what lies beside that one.
    void force_longest()
    {
        std::unordered_set<std::uint64_t> cut(cut_edges_.begin(), cut_edges_.end());
        std::vector<bool> is_end(positions_.size(), false);
        for (const std::uint64_t edge : cut_edges_)
            is_end[edge >> 32] = is_end[edge & 0xFFFFFFFFu] = true;
        const auto is_cut = [&](const Piece& piece, int corner) {
            return is_end[welded_[piece.vertices[corner]]] &&
                   is_end[welded_[piece.vertices[next(corner)]]] &&
                   cut.contains(edge_of(piece, corner));
        };
        forced_.clear();
        for (std::size_t before = cut.size() + 1; before != cut.size();) {
            before = cut.size();
            for (const Piece& piece : pieces_) {
                if (!is_cut(piece, 0) && !is_cut(piece, 1) && !is_cut(piece, 2))
                    continue;
                const std::uint64_t edge = edge_of(piece, longest_of(piece));
                if (!cut.insert(edge).second)
                    continue;
                forced_.push_back(edge);
                is_end[edge >> 32] = is_end[edge & 0xFFFFFFFFu] = true;
            }
        }
        std::ranges::sort(forced_);
    }

    /// Those of which nothing is known yet, edge by edge.
    std::vector<AskedSide> sides_to_ask()
    {
        std::vector<AskedSide> sides;
        for (std::uint32_t p = 0; p < pieces_.size(); ++p) {
            Piece& piece = pieces_[p];
            if (in_geometry_[old_of_[p]] == kNowhere)
                continue;
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint64_t edge = edge_of(piece, corner);
                const bool is_known =
                    (piece.straight >> corner & 1) != 0 || !is_long(piece, corner);
                piece.straight = static_cast<std::uint8_t>(piece.straight | 1 << corner);
                if (is_known && !std::ranges::binary_search(forced_, edge))
                    continue;
                sides.push_back({edge,
                                 pair_of(piece.vertices[corner], piece.vertices[next(corner)]), p,
                                 static_cast<std::uint32_t>(corner)});
            }
        }
        tbb::parallel_sort(sides.begin(), sides.end());
        return sides;
    }

    [[nodiscard]] SurfacePoint middle_of(const AskedSide& side) const
    {
        const Piece& piece = pieces_[side.piece];
        const auto corner = static_cast<int>(side.corner);
        return {in_geometry_[old_of_[side.piece]],
                0.5f * (weights_of(piece, corner) + weights_of(piece, next(corner)))};
    }

    /// The same a little way into the piece, at a right angle to the edge, as
    /// receivers_at_wedges() stands off a vertex at the end of a surface.
    [[nodiscard]] SurfacePoint inside_of(const AskedSide& side) const
    {
        const Piece& piece = pieces_[side.piece];
        const auto a = static_cast<int>(side.corner);
        const int b = next(a), c = next(b);
        const glm::vec3 along = positions_[piece.vertices[b]] - positions_[piece.vertices[a]];
        const glm::vec3 other = positions_[piece.vertices[c]] - positions_[piece.vertices[a]];
        const float foot = glm::dot(other, along) / glm::dot(along, along);
        const float height = glm::length(other - foot * along);
        SurfacePoint point = middle_of(side);
        const float inset = kInset * offset_at(mesh_.geometry, point.triangle, offset_);
        const float share = height > 2.0f * inset ? inset / height : 0.5f;
        const glm::vec2 from = weights_of(piece, a);
        point.at += share * (weights_of(piece, c) - from - foot * (weights_of(piece, b) - from));
        return point;
    }

    static glm::vec2 weights_of(const Piece& piece, int corner)
    {
        return weights_at(glm::vec2(piece.places[static_cast<std::size_t>(corner)]));
    }

    [[nodiscard]] glm::vec3 up_of(const AskedSide& side) const
    {
        const glm::uvec3& t = mesh_.geometry.triangles[in_geometry_[old_of_[side.piece]]];
        const std::vector<glm::vec3>& p = mesh_.geometry.positions;
        return glm::normalize(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
    }

    /// Whether the surface goes on from one side to the other: then the very edge can be asked.
    [[nodiscard]] bool is_smooth(std::span<const AskedSide> edge, const Receiver* middles) const
    {
        // beyond a right angle a middle may stand on the wrong side of the other face
        constexpr float kLeastCosine = 0.5f;
        return edge.size() == 2 && glm::dot(middles[0].normal, middles[1].normal) >= kSameNormal &&
               glm::dot(up_of(edge[0]), up_of(edge[1])) >= kLeastCosine;
    }

    /// Asks the middles of sides and finds the edges to be cut, with what vertices there hold.
    void ask_sides(const std::vector<AskedSide>& sides)
    {
        std::vector<SurfacePoint> points;
        for (const AskedSide& side : sides)
            points.push_back(middle_of(side));
        const std::vector<Receiver> middles =
            receivers_at(mesh_.geometry, mesh_.surface, points, offset_);
        std::vector<Receiver> receivers;
        std::vector<std::uint32_t> answer_of(sides.size());
        for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
            const bool smooth =
                is_smooth(std::span(sides).subspan(begin, end - begin), &middles[begin]);
            for (std::size_t i = begin; i < end; ++i) {
                if (smooth && i > begin) {
                    answer_of[i] = answer_of[begin];
                    continue;
                }
                answer_of[i] = static_cast<std::uint32_t>(receivers.size());
                const SurfacePoint inside = inside_of(sides[i]);
                receivers.push_back(
                    smooth ? middles[i]
                           : receivers_at(mesh_.geometry, mesh_.surface, {&inside, 1}, offset_)[0]);
            }
        });
        decide(sides, ask(receivers), answer_of);
    }

    template <class Visit>
    static void for_each_edge(const std::vector<AskedSide>& sides, const Visit& visit)
    {
        for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
            while (end < sides.size() && sides[end].edge == sides[begin].edge)
                ++end;
            visit(begin, end);
        }
    }

    void decide(const std::vector<AskedSide>& sides, const std::vector<Occlusion>& answers,
                const std::vector<std::uint32_t>& answer_of)
    {
        for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
            bool bends = std::ranges::binary_search(forced_, sides[begin].edge);
            const std::size_t before = middles_.size();
            for (std::size_t i = begin; i < end;) {
                // the sides of one vertex
                const std::uint64_t ends = sides[i].vertices;
                double sum = 0.0, count = 0.0;
                for (; i < end && sides[i].vertices == ends; ++i) {
                    sum += answers[answer_of[i]].occlusion;
                    count += 1.0;
                }
                const auto value = static_cast<float>(sum / count);
                bends = bends || std::abs(value - mean_at(ends)) > most_bend_of(ends);
                middles_.push_back({ends, value});
            }
            if (bends)
                cut_edges_.push_back(sides[begin].edge);
            else
                middles_.resize(before);
        });
        std::ranges::sort(cut_edges_);
        std::ranges::sort(middles_);
    }

    /// An edge between two vertices of the file is one of the file.
    [[nodiscard]] float most_bend_of(std::uint64_t vertices) const
    {
        const bool is_old = (vertices & 0xFFFFFFFFu) < mesh_.scene.positions.size();
        return is_old ? tolerance_ : (1.0f - kPieceMargin) * tolerance_;
    }

    [[nodiscard]] float mean_at(std::uint64_t vertices) const
    {
        return 0.5f * (values_[vertices >> 32] + values_[vertices & 0xFFFFFFFFu]);
    }

    /// For all vertices at the edges that are cut, those of triangles without area too.
    void add_vertices()
    {
        std::vector<bool> is_end(positions_.size(), false);
        for (const std::uint64_t edge : cut_edges_)
            is_end[edge >> 32] = is_end[edge & 0xFFFFFFFFu] = true;
        std::vector<std::uint32_t> welded_at(cut_edges_.size(), kNowhere);
        new_vertices_.clear();
        for (const Piece& piece : pieces_) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t a = piece.vertices[corner], b = piece.vertices[next(corner)];
                if (!is_end[welded_[a]] || !is_end[welded_[b]])
                    continue;
                const auto edge = std::ranges::lower_bound(cut_edges_, edge_of(piece, corner));
                if (edge == cut_edges_.end() || *edge != edge_of(piece, corner))
                    continue;
                const auto vertex = static_cast<std::uint32_t>(positions_.size());
                if (!new_vertices_.try_emplace(pair_of(a, b), vertex).second)
                    continue;
                std::uint32_t& welded =
                    welded_at[static_cast<std::size_t>(edge - cut_edges_.begin())];
                welded = std::min(welded, vertex);
                add_vertex(pair_of(a, b), welded);
            }
        }
    }

    void check_count(std::size_t count, const char* what) const
    {
        if (count > kMostElements)
            throw InputError(mesh_.scene.name + ": would have more than " +
                             std::to_string(kMostElements) + ' ' + what +
                             " when subdivided; a larger tolerance helps");
    }

    void add_vertex(std::uint64_t ends, std::uint32_t welded)
    {
        check_count(positions_.size() + 1, "vertices");
        const auto a = static_cast<std::uint32_t>(ends >> 32),
                   b = static_cast<std::uint32_t>(ends & 0xFFFFFFFFu);
        const auto known = std::ranges::lower_bound(middles_, ends, {}, &Middle::vertices);
        const bool is_known = known != middles_.end() && known->vertices == ends;
        values_.push_back(is_known ? known->value : mean_at(ends));
        positions_.push_back(0.5f * (positions_[a] + positions_[b]));
        welded_.push_back(welded);
        parents_.emplace_back(a, b);
    }

    void cut_pieces()
    {
        std::vector<Piece> pieces;
        std::vector<std::uint32_t> old_of, first;  // the last: of each piece's own
        pieces.reserve(pieces_.size() + 3 * new_vertices_.size());
        for (std::uint32_t p = 0; p < pieces_.size(); ++p) {
            first.push_back(static_cast<std::uint32_t>(pieces.size()));
            cut(pieces_[p], pieces);
            old_of.resize(pieces.size(), old_of_[p]);
        }
        check_count(pieces.size(), "triangles");
        first.push_back(static_cast<std::uint32_t>(pieces.size()));
        pieces_ = std::move(pieces);
        old_of_ = std::move(old_of);
        for (Probe& probe : probes_)
            probe.piece = piece_around(probe, first[probe.piece], first[probe.piece + 1]);
    }

    [[nodiscard]] std::uint32_t piece_around(const Probe& probe, std::uint32_t begin,
                                             std::uint32_t end) const
    {
        std::uint32_t best = begin;
        float most = -std::numeric_limits<float>::max();
        for (std::uint32_t p = begin; p < end; ++p) {
            const glm::vec3 share = shares(pieces_[p], probe.place);
            const float least = std::min({share.x, share.y, share.z});
            if (least > most) {
                most = least;
                best = p;
            }
        }
        return best;
    }

    /// Appends what becomes of a piece.
    void cut(const Piece& piece, std::vector<Piece>& pieces) const
    {
        std::array<std::uint32_t, 3> middle{};
        int count = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const auto found =
                new_vertices_.find(pair_of(piece.vertices[corner], piece.vertices[next(corner)]));
            const bool is_cut = found != new_vertices_.end();
            middle[static_cast<std::size_t>(corner)] = is_cut ? found->second : kNowhere;
            count += is_cut ? 1 : 0;
        }
        if (count == 0) {
            pieces.push_back(piece);
            return;
        }
        // corners 0 to 2, and 3 to 5 the middles behind them
        const auto add = [&](std::array<int, 3> corners) {
            Piece& part = pieces.emplace_back();
            for (int k = 0; k < 3; ++k) {
                const int c = corners[static_cast<std::size_t>(k)], other = corners[next(k)];
                part.vertices[k] =
                    c < 3 ? piece.vertices[c] : middle[static_cast<std::size_t>(c - 3)];
                part.places[static_cast<std::size_t>(k)] = place_of(piece, c);
                const bool is_whole = c < 3 && other == next(c);
                if (is_whole && (piece.straight >> c & 1) != 0)
                    part.straight = static_cast<std::uint8_t>(part.straight | 1 << k);
            }
        };
        const auto is_cut = [&](int corner) {
            return middle[static_cast<std::size_t>(corner)] != kNowhere;
        };
        if (count == 3) {
            for (const std::array<int, 3>& corners :
                 {std::array{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
                add(corners);
            return;
        }
        // behind the first corner lies the only edge that is cut, or the only one that is not
        int a = 0;
        while (is_cut(a) != (count == 1))
            ++a;
        const int b = next(a), c = next(b);
        if (count == 1) {
            add({a, a + 3, c});
            add({a + 3, b, c});
            return;
        }
        add({c, c + 3, b + 3});
        if (length_of(piece, b) >= length_of(piece, c)) {
            add({a, b, b + 3});
            add({a, b + 3, c + 3});
        } else {
            add({a, b, c + 3});
            add({b, b + 3, c + 3});
        }
    }

    static Place place_of(const Piece& piece, int corner)
    {
        const auto at = [&](int k) { return piece.places[static_cast<std::size_t>(k)]; };
        if (corner < 3)
            return at(corner);
        return Place((glm::uvec2(at(corner - 3)) + glm::uvec2(at(next(corner - 3)))) / 2u);
    }

    /// What a vertex at the middle of an edge holds.
    struct Middle {
        std::uint64_t vertices = 0;
        float value = 0.0f;
        auto operator<=>(const Middle&) const = default;
    };

    const Mesh& mesh_;
    float tolerance_;
    const Offset& offset_;
    const Ask& ask_;
    const Progress& progress_;
    double done_ = 0.0;
    // per vertex
    std::vector<glm::vec3> positions_;  ///< unit frame
    std::vector<std::uint32_t> welded_;
    std::vector<float> values_;
    std::vector<glm::uvec2> parents_;         ///< of the new ones
    std::vector<std::uint32_t> in_geometry_;  ///< per old triangle; kNowhere: it is not there
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> old_of_;  ///< per piece
    std::vector<Probe> probes_;
    // of the round
    std::vector<std::uint64_t> forced_, cut_edges_;                  ///< welded edges, rising
    std::vector<Middle> middles_;                                    ///< rising
    std::unordered_map<std::uint64_t, std::uint32_t> new_vertices_;  ///< by the ends
    Subdivision result_;
};

}  // namespace

Subdivision subdivide(const Mesh& mesh, double tolerance, const Offset& offset, const Ask& ask,
                      const Progress& progress)
{
    require(tolerance > 0.0, "the tolerance of a subdivision must be above 0");
    return Subdivider(mesh, tolerance, offset, ask, progress).run();
}

}  // namespace surfelao
