#include "tree/masks/memory.h"

#include "surfels/for_all.h"
#include "surfels/stopwatch.h"
#include "tree/masks/constants.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kBodiesAWord = 64;

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
      solver_(options),
      words_((forest.body_count() + kBodiesAWord - 1) / kBodiesAWord),
      versions_(forest.body_count(), 0)
{
    auto index = members_of(body_of_receiver, forest.body_count());
    for (std::uint32_t body = 0; body < forest.body_count(); ++body) {
        if (index[body].empty())
            continue;
        OfBody& of = of_bodies_.emplace_back();
        of.body = body;
        of.index = std::move(index[body]);
        group(of, at_rest);
        const std::size_t bytes =
            of.share.size() * solver_.settings().limits.count * sizeof(MaskKept);
        of.may_keep = forest.body_count() > 1 && bytes <= keep_most;
        keep_most -= of.may_keep ? bytes : 0;
    }
}

void MaskMemory::group(OfBody& of, std::span<const Receiver> at_rest)
{
    of.receivers.resize(of.index.size());
    for (std::size_t i = 0; i < of.index.size(); ++i)
        of.receivers[i] = at_rest[of.index[i]];
    of.groups = group_receivers(of.receivers, kMaskFrame);
    of.share = leaves_of(options_.share, of.groups);
    of.seen.assign(words_ * of.share.size(), 0);
    of.answers.assign(of.receivers.size(), {});
    of.kept_within.reset();
    of.is_new = true;
    if (of.groups.groups.empty())
        return;
    const ReceiverGroup& root = of.groups.groups[0];
    of.ball = {{root.center[0], root.center[1], root.center[2]}, 0.0f};
    for (const ReceiverGroup& group : of.groups.groups) {
        const glm::vec3 center(group.center[0], group.center[1], group.center[2]);
        if (group.first_child == 0)
            of.ball.radius =
                std::max(of.ball.radius, glm::distance(center, of.ball.center) + group.radius);
    }
    for (std::size_t leaf = 0; leaf < of.share.size(); ++leaf) {
        const ReceiverGroup& group = of.groups.groups[of.groups.leaves[leaf]];
        for (std::uint32_t i = group.begin; of.share[leaf] == 0 && i < group.end; ++i)
            of.answers[of.groups.order[i]] = kUnsolved;
    }
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

/// A form that bends has another tree in each frame: to keep its masks would cost and not save.
bool MaskMemory::is_kept(const OfBody& of) const
{
    return of.may_keep && !forest_.is_deformed(of.body);
}

/// A body that grows has other limits in its own space.
bool MaskMemory::is_to_keep(const OfBody& of) const
{
    return is_kept(of) && of.kept_within != definition_of(of).max_distance;
}

/// As it is in the body's own space.
Definition MaskMemory::definition_of(const OfBody& of) const
{
    const Placement& placement = *forest_.placement(of.body);
    Definition own = options_.definition;
    own.max_distance = static_cast<float>(own.max_distance / placement.scale);
    if (own.ground) {
        const glm::dvec3 up(own.ground->up);
        own.ground->height = static_cast<float>(
            (own.ground->height - glm::dot(up, placement.translation)) / placement.scale);
        own.ground->up = glm::vec3(glm::transpose(placement.rotation) * up);
    }
    return own;
}

/// Sets the bits of the bodies that a group looks at, its own apart. Returns what the others cover
/// at most.
float MaskMemory::look_around(const OfBody& of, const ReceiverGroup& group, float limit,
                              std::uint64_t* seen) const
{
    const auto look_at = [&](std::uint32_t body) {
        seen[body / kBodiesAWord] |= std::uint64_t{1} << body % kBodiesAWord;
    };
    std::vector<std::pair<float, std::uint32_t>> little;
    float covered = 0.0f;
    for (std::uint32_t body = 0; body < forest_.body_count(); ++body) {
        if (body == of.body || !forest_.root(body))
            continue;
        const float most = most_covered(group, of.balls[body], limit);
        if (most > tolerance_) {
            look_at(body);
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
            look_at(body);
    }
    return covered;
}

/// Which leaf groups are to be answered, and what each looks at. Returns the bound.
float MaskMemory::find_wanted(OfBody& of)
{
    std::vector<std::uint64_t> moved(words_, 0);
    of.balls.resize(forest_.body_count());
    for (std::uint32_t body = 0; body < forest_.body_count(); ++body) {
        if (is_moved(body))
            moved[body / kBodiesAWord] |= std::uint64_t{1} << body % kBodiesAWord;
        if (forest_.root(body))
            of.balls[body] = forest_.ball_before(of.body, body);
    }
    const bool own = all_ || of.is_new || is_moved(of.body);
    const float limit = definition_of(of).max_distance;
    of.wanted = of.share;
    constexpr std::size_t kGrain = 64;
    std::vector<float> bounds(of.wanted.size(), 0.0f);
    for_ranges(0, of.wanted.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint64_t> now(words_);
        for (std::size_t leaf = begin; leaf < end; ++leaf) {
            const ReceiverGroup& group = of.groups.groups[of.groups.leaves[leaf]];
            std::ranges::fill(now, std::uint64_t{0});
            bounds[leaf] = look_around(of, group, limit, now.data());
            bool changed = own;
            for (std::size_t word = 0; word < words_; ++word) {
                std::uint64_t& seen = of.seen[leaf * words_ + word];
                changed |= now[word] != seen || (now[word] & moved[word]) != 0;
                seen = now[word];
            }
            if (!changed)
                of.wanted[leaf] = 0;
        }
    });
    return bounds.empty() ? 0.0f : std::ranges::max(bounds);
}

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

/// The nodes of all bodies that its leaf groups look at, and its own.
const MaskNode* MaskMemory::nodes_before(const OfBody& of, bool with_own)
{
    if (of.body == 0)
        return forest_.nodes();
    std::vector<std::uint64_t> looked_at(words_, 0);
    for (std::size_t leaf = 0; leaf < of.wanted.size(); ++leaf) {
        for (std::size_t word = 0; word < words_ && of.wanted[leaf] != 0; ++word)
            looked_at[word] |= of.seen[leaf * words_ + word];
    }
    std::vector<std::uint32_t> bodies;
    if (with_own && forest_.root(of.body))
        bodies.push_back(of.body);
    for_bits(looked_at.data(), words_, [&](std::uint32_t body) { bodies.push_back(body); });
    forest_.place_before(
        {of.body, of.ball, solver_.settings().cluster * solver_.settings().crossing,
         solver_.settings().limits.distance[solver_.settings().limits.count - 1]},
        bodies, before_);
    return before_.data();
}

void MaskMemory::solve(OfBody& of, MaskFrame& frame, ProgressMeter& meter)
{
    const Definition definition = definition_of(of);
    solver_.ask(definition);
    const bool keeps = is_kept(of);
    const bool is_first = is_to_keep(of);
    std::vector<std::uint32_t> roots;
    if (const auto root = forest_.root(of.body))
        roots.push_back(*root);
    const MaskSkies skies(definition, of.receivers);
    const MaskLeafRoots leaf_roots = leaf_roots_of(of);
    Stopwatch watch;
    const MaskNode* nodes = nodes_before(of, is_first || !keeps);
    frame.place += watch.lap();
    MaskQuestion question{nodes, roots, of.receivers, of.groups, skies, of.wanted, &leaf_roots};
    if (!keeps) {
        solver_.solve(question, meter, of.answers);
        return;
    }
    if (is_first) {
        of.kept_within.reset();
        of.kept.resize(of.wanted.size() * solver_.settings().limits.count);
        question.wanted = of.share;
        solver_.keep(question, meter, of.kept);
        question.wanted = of.wanted;
        of.kept_within = definition.max_distance;
    }
    solver_.solve_kept(question, of.kept, meter, of.answers);
}

/// Turned to where the body is. Returns how many are new.
std::uint64_t MaskMemory::write_answers(const OfBody& of, std::span<Occlusion> answers) const
{
    const glm::dmat3& rotation = forest_.placement(of.body)->rotation;
    const bool is_turned = rotation != glm::dmat3(1.0);
    std::uint64_t solved = 0;
    for (std::size_t leaf = 0; leaf < of.wanted.size(); ++leaf) {
        const ReceiverGroup& group = of.groups.groups[of.groups.leaves[leaf]];
        if (of.wanted[leaf] == 0 && !of.is_new)
            continue;
        solved += of.wanted[leaf] != 0 ? group.end - group.begin : 0;
        for (std::uint32_t i = group.begin; i < group.end; ++i) {
            const std::uint32_t receiver = of.groups.order[i];
            Occlusion& answer = answers[of.index[receiver]];
            answer = of.answers[receiver];
            if (is_turned)
                answer.bent_normal = glm::vec3(rotation * glm::dvec3(answer.bent_normal));
        }
    }
    return solved;
}

MaskFrame MaskMemory::solve(std::span<Occlusion> answers, const Progress& progress)
{
    MaskFrame frame;
    std::uint64_t leaves = 0;
    std::vector<OfBody*> there;
    for (OfBody& of : of_bodies_) {
        if (!forest_.placement(of.body) || of.groups.groups.empty())
            continue;
        there.push_back(&of);
        frame.bound = std::max(frame.bound, find_wanted(of));
        const auto wanted = static_cast<std::uint64_t>(std::ranges::count(of.wanted, 1));
        leaves += wanted;
        if (wanted > 0 && is_to_keep(of))
            leaves += static_cast<std::uint64_t>(std::ranges::count(of.share, 1));
    }
    all_ = true;  // until all is well
    ProgressMeter meter(progress, leaves);
    for (OfBody* of : there) {
        if (std::ranges::find(of->wanted, 1) != of->wanted.end())
            solve(*of, frame, meter);
        frame.solved += write_answers(*of, answers);
        of->is_new = false;
    }
    for (std::uint32_t body = 0; body < forest_.body_count(); ++body)
        versions_[body] = forest_.version(body);
    all_ = false;
    return frame;
}

}  // namespace surfelao
