#include "tree/masks/memory.h"

#include "tree/masks/constants.h"

#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kBodiesAWord = 64;

bool has(const std::uint64_t* bits, std::uint32_t body)
{
    return (bits[body / kBodiesAWord] >> (body % kBodiesAWord) & 1u) != 0;
}

/// work(body) for each bit, in order.
template <class Work>
void for_bits(const std::uint64_t* bits, std::size_t words, const Work& work)
{
    for (std::size_t word = 0; word < words; ++word) {
        for (std::uint64_t left = bits[word]; left != 0; left &= left - 1)
            work(static_cast<std::uint32_t>(word * kBodiesAWord) +
                 static_cast<std::uint32_t>(std::countr_zero(left)));
    }
}

}  // namespace

float most_covered(const ReceiverGroup& group, const MaskBall& ball, float limit)
{
    const glm::vec3 to = ball.center - glm::vec3(group.center[0], group.center[1], group.center[2]);
    const float distance = glm::length(to);
    const float nearest = distance - group.radius;  // of the ball's centre
    if (nearest - ball.radius >= limit)
        return 0.0f;
    // the same steps as in the kernels' see(): what is left out here is not alive there
    const float height = glm::dot(to, glm::vec3(group.axis[0], group.axis[1], group.axis[2]));
    const float aside = std::sqrt(std::max(0.0f, distance * distance - height * height));
    const float base = height < group.cone_cos * distance
                           ? height * group.cone_cos + aside * group.cone_sin
                           : distance;
    const float top = base + ball.radius + group.rise;
    if (!(top > 0.0f))
        return 0.0f;
    if (!(nearest > ball.radius))
        return 1.0f;
    const float sine = ball.radius / nearest;
    const float share = sine * sine;
    const float cap = 2.0f * share / (1.0f + std::sqrt(1.0f - share));  // solid angle over pi
    return std::min(share, cap * top / (nearest - ball.radius));
}

MaskMemory::MaskMemory(const MaskForest& forest, std::span<const Receiver> at_rest,
                       std::span<const std::uint32_t> body_of_receiver, const MaskOptions& options,
                       float tolerance, std::size_t keep_most)
    : forest_(forest),
      options_(options),
      tolerance_(tolerance),
      keep_most_(keep_most),
      solver_(options),
      words_((forest.body_count() + kBodiesAWord - 1) / kBodiesAWord),
      versions_(forest.body_count(), 0)
{
    std::vector<std::vector<std::uint32_t>> index(forest.body_count());
    for (std::size_t i = 0; i < at_rest.size(); ++i)
        index[body_of_receiver[i]].push_back(static_cast<std::uint32_t>(i));
    for (std::uint32_t body = 0; body < forest.body_count(); ++body) {
        if (index[body].empty())
            continue;
        OfBody& of = of_bodies_.emplace_back();
        of.body = body;
        of.index = std::move(index[body]);
        group(of, at_rest);
    }
}

/// The receivers of a body at rest.
void MaskMemory::group(OfBody& of, std::span<const Receiver> at_rest)
{
    of.now.resize(of.index.size());
    for (std::size_t i = 0; i < of.index.size(); ++i)
        of.now[i] = at_rest[of.index[i]];
    of.at_rest = group_receivers(of.now, kMaskFrame);
    of.share = leaves_of(options_.share, of.at_rest);
    of.seen.assign(words_ * (of.body == 0 ? of.share.size() : 1), 0);
    of.answers.assign(of.now.size(), {});
    for (std::size_t leaf = 0; leaf < of.share.size(); ++leaf) {
        const ReceiverGroup& group = of.at_rest.groups[of.at_rest.leaves[leaf]];
        for (std::uint32_t i = group.begin; of.share[leaf] == 0 && i < group.end; ++i)
            of.answers[of.at_rest.order[i]] = kUnsolved;
    }
    of.is_kept = false;
    of.is_new = true;
}

void MaskMemory::deform(std::uint32_t body, std::span<const Receiver> at_rest)
{
    for (OfBody& of : of_bodies_) {
        if (of.body == body)
            group(of, at_rest);
    }
}

bool MaskMemory::is_moved(std::uint32_t body) const
{
    return all_ || forest_.version(body) != versions_[body];
}

/// Groups, receivers and skies to where the body is.
void MaskMemory::set_place(OfBody& of, std::span<const Receiver> now)
{
    for (std::size_t i = 0; i < of.index.size(); ++i)
        of.now[i] = now[of.index[i]];
    place_groups(of.at_rest, *forest_.placement(of.body), kMaskFrame, of.groups);
    of.skies.emplace(options_.definition, of.now);
}

/// Sets the bits of the bodies that a group looks at, its own and body 0 apart. Returns what the
/// others cover at most.
float MaskMemory::look_around(const ReceiverGroup& group, std::uint32_t own,
                              std::uint64_t* seen) const
{
    std::fill_n(seen, words_, 0);
    std::vector<std::pair<float, std::uint32_t>> little;
    float covered = 0.0f;
    for (std::uint32_t body = 1; body < forest_.body_count(); ++body) {
        if (body == own || !forest_.root(body))
            continue;
        const float most =
            most_covered(group, forest_.ball(body), options_.definition.max_distance);
        if (most > tolerance_) {
            seen[body / kBodiesAWord] |= std::uint64_t{1} << body % kBodiesAWord;
        } else if (most > 0.0f) {
            little.emplace_back(most, body);
            covered += most;
        }
    }
    if (covered <= tolerance_)
        return covered;
    std::ranges::sort(little);
    covered = 0.0f;
    for (const auto& [most, body] : little) {
        if (covered + most <= tolerance_)
            covered += most;
        else
            seen[body / kBodiesAWord] |= std::uint64_t{1} << body % kBodiesAWord;
    }
    return covered;
}

/// Which leaf groups are to be answered, and what each looks at. Returns the bound.
float MaskMemory::find_wanted(OfBody& of)
{
    std::vector<std::uint64_t> moved(words_, 0);
    for (std::uint32_t body = 1; body < forest_.body_count(); ++body) {
        if (is_moved(body))
            moved[body / kBodiesAWord] |= std::uint64_t{1} << body % kBodiesAWord;
    }
    const bool own = all_ || of.is_new || has(moved.data(), of.body);
    const auto is_changed = [&](const ReceiverGroup& group, std::uint64_t* seen, float& bound) {
        std::vector<std::uint64_t> now(words_);
        bound = std::max(bound, look_around(group, of.body, now.data()));
        bool changed = own;
        for (std::size_t word = 0; word < words_; ++word) {
            changed |= now[word] != seen[word] || (now[word] & moved[word]) != 0;
            seen[word] = now[word];
        }
        return changed;
    };
    of.wanted = of.share;
    if (of.groups.groups.empty())
        return 0.0f;
    if (of.body != 0) {
        float bound = 0.0f;
        if (!is_changed(of.groups.groups[0], of.seen.data(), bound))
            std::ranges::fill(of.wanted, std::uint8_t{0});
        return bound;
    }
    constexpr std::size_t kGrain = 64;
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, of.wanted.size(), kGrain), 0.0f,
        [&](const tbb::blocked_range<std::size_t>& range, float bound) {
            for (std::size_t leaf = range.begin(); leaf < range.end(); ++leaf) {
                const ReceiverGroup& group = of.groups.groups[of.groups.leaves[leaf]];
                if (!is_changed(group, &of.seen[leaf * words_], bound))
                    of.wanted[leaf] = 0;
            }
            return bound;
        },
        [](float a, float b) { return std::max(a, b); });
}

/// Of the receivers of body 0.
MaskLeafRoots MaskMemory::leaf_roots_of(const OfBody& of) const
{
    MaskLeafRoots roots;
    roots.begin.reserve(of.wanted.size() + 1);
    for (std::size_t leaf = 0; leaf < of.wanted.size(); ++leaf) {
        roots.begin.push_back(static_cast<std::uint32_t>(roots.roots.size()));
        if (of.wanted[leaf] == 0)
            continue;
        for_bits(&of.seen[leaf * words_], words_,
                 [&](std::uint32_t body) { roots.roots.push_back(*forest_.root(body)); });
    }
    roots.begin.push_back(static_cast<std::uint32_t>(roots.roots.size()));
    return roots;
}

bool MaskMemory::may_keep(const OfBody& of) const
{
    const std::size_t count = of.wanted.size() * solver_.limits().size();
    return forest_.body_count() > 1 && count <= keep_most_ / sizeof(MaskKept);
}

void MaskMemory::solve(OfBody& of, ProgressMeter& meter)
{
    std::vector<std::uint32_t> roots;
    const auto add_root = [&](std::uint32_t body) {
        if (const auto root = forest_.root(body))
            roots.push_back(*root);
    };
    add_root(0);
    if (of.body != 0) {
        add_root(of.body);
        for_bits(of.seen.data(), words_, add_root);
        solver_.solve({forest_.nodes(), roots, of.now, of.groups, *of.skies, of.wanted}, meter,
                      of.answers);
        return;
    }
    const MaskLeafRoots leaf_roots = leaf_roots_of(of);
    const MaskQuestion question{forest_.nodes(), roots,     of.now,     of.groups,
                                *of.skies,       of.wanted, &leaf_roots};
    if (!may_keep(of)) {
        solver_.solve(question, meter, of.answers);
        return;
    }
    if (!of.is_kept) {
        of.kept.resize(of.wanted.size() * solver_.limits().size());
        solver_.keep(question, meter, of.kept);
        of.is_kept = true;
    }
    solver_.solve_kept(question, of.kept, meter, of.answers);
}

MaskFrame MaskMemory::solve(std::span<const Receiver> now, std::span<Occlusion> answers,
                            const Progress& progress)
{
    MaskFrame frame;
    const bool all = all_;
    std::uint64_t leaves = 0;
    std::vector<OfBody*> there;
    for (OfBody& of : of_bodies_) {
        if (!forest_.placement(of.body))
            continue;
        there.push_back(&of);
        if (is_moved(of.body) || of.is_new)
            set_place(of, now);
        frame.bound = std::max(frame.bound, find_wanted(of));
        const auto wanted = static_cast<std::uint64_t>(std::ranges::count(of.wanted, 1));
        leaves += wanted * (of.body == 0 && !of.is_kept && may_keep(of) ? 2 : 1);
    }
    all_ = true;  // until all is well
    ProgressMeter meter(progress, leaves * solver_.limits().size());
    for (OfBody* of : there) {
        solve(*of, meter);
        for (std::size_t leaf = 0; leaf < of->wanted.size(); ++leaf) {
            const ReceiverGroup& group = of->groups.groups[of->groups.leaves[leaf]];
            if (!all && !of->is_new && of->wanted[leaf] == 0)
                continue;
            if (of->wanted[leaf] != 0)
                frame.solved += group.end - group.begin;
            for (std::uint32_t i = group.begin; i < group.end; ++i) {
                const std::uint32_t receiver = of->groups.order[i];
                answers[of->index[receiver]] = of->answers[receiver];
            }
        }
    }
    for (OfBody* of : there)
        of->is_new = false;
    for (std::uint32_t body = 0; body < forest_.body_count(); ++body)
        versions_[body] = forest_.version(body);
    all_ = false;
    return frame;
}

}  // namespace surfelao
