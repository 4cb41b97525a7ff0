/// judge.h: runs one hard case through one engine and says whether the answer stands.
#pragma once

#include "engines/engine.h"
#include "tests/stability/world.h"

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace surfelao::stability {

/// Error in occlusion over the well-defined receivers of one case.
struct Bound {
    double rms = 0.0;
    double worst = 0.0;
};

/// Answers receivers about the geometry that it was made for, as often as it is asked.
using Solver =
    std::function<std::vector<Occlusion>(std::span<const Receiver>, const SolveSettings&)>;

/// An engine at one setting.
struct Engine {
    std::string name;
    Bound bound;
    bool may_be_excused = false;  ///< by Case::disks_excused
    bool skips_slow = false;      ///< not run where Case::slow
    std::string built;  ///< engines with the same word here share what they have built of a case
    std::function<Solver(const Geometry&)> prepare;
    SolveSettings settings = {};  ///< the definition apart: that is the world's
    bool asks_few = false;        ///< held to account at kFewReceivers: dear by the receiver
    /// Receivers of the second run, the first ones; 0: all. For engines whose answers depend on
    /// nothing but the receiver and its index.
    std::size_t repeats = 0;
};

/// What engines have built of the worlds of one case, which must outlive it.
class Built {
public:
    /// Made when first asked for, by the number of threads that the caller has.
    const Solver& of(const Engine& engine, const World& world, int threads);

private:
    std::map<std::tuple<std::string, const World*, int>, Solver> solvers_;
};

enum class Verdict { pass, excused, undefined, fail };

/// What one engine made of one case.
struct Finding {
    Verdict verdict = Verdict::pass;
    Bound error;
    Bound bound;
    std::string fault;  ///< one phrase where the verdict is `fail`
};

/// A case with its right answers, made once for all engines.
struct Trial {
    World world;
    std::vector<double> truth;  ///< one per receiver; empty where the case is compared with `like`
    std::vector<bool> has_answer;  ///< one per receiver: well-defined (reference/well_defined.h)
    std::size_t undefined = 0;     ///< receivers that are not
};

/// Software GPUs take about a hundred times as long for a receiver; whatever a case shows, it shows
/// at this many.
inline constexpr std::size_t kFewReceivers = 150;

/// At most so many of the receivers, evenly spread over their order; the same scenes and answers.
[[nodiscard]] Trial thinned(const Trial& trial, std::size_t most);

/// Traces what is needed: the rule for every receiver, and 4096 robust rays where there is no
/// closed form.
[[nodiscard]] Trial prepare(World world);

/// The answers of one thread, and what is wrong with them whatever the right ones are.
struct Answers {
    std::vector<Occlusion> occlusion;
    std::string fault;  ///< one phrase; empty where nothing is
};

/// Builds and solves twice, on one thread and on several, and checks in this order: one answer per
/// receiver, all numbers finite, occlusion in [0, 1], bent normals of unit length and not below the
/// horizon (receivers without a normal: occlusion 0, bent normal zero), both runs equal in every
/// byte (of the first Engine::repeats receivers). Throws what the engine throws.
[[nodiscard]] Answers solve_twice(const World& world, const Engine& engine, Built& built);

/// Solves twice, and checks in this order: it did not throw, solve_twice found no fault, errors
/// within the bound. Against `like` the bound is doubled: both sides may be off. `excuse`:
/// Case::disks_excused; it forgives the error only.
[[nodiscard]] Finding judge(const Trial& trial, const Engine& engine, const std::string& excuse,
                            Built& built);

}  // namespace surfelao::stability
