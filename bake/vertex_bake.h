/// vertex_bake.h: from a mesh to values at its vertices that say how wrong they are, by the engine
/// that was asked for or by the cheapest that is exact enough.
#pragma once

#include "bake/error_search.h"
#include "bake/stated_error.h"
#include "bake/vertex_target.h"
#include "engines/engine.h"
#include "surfels/occlusion.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace surfelao {

/// Wall-clock seconds of each stage; of several trials the sums.
struct VertexBakeSeconds {
    double surfels = 0.0;  ///< what the engine makes of the mesh first
    double tree = 0.0;
    double solve = 0.0;
    double fit = 0.0;    ///< from the answers to the values at vertices
    double check = 0.0;  ///< from the values to their error
};

struct VertexBake {
    EngineSettings engine;           ///< who answered
    std::vector<Occlusion> answers;  ///< one per receiver of the target
    std::vector<Occlusion> values;   ///< one per vertex
    std::optional<double> residual;  ///< of the disk engine's correction
    std::uint64_t surfels = 0;
    std::optional<StatedError> error;
    std::vector<Trial> trials;  ///< of bake_to_error(), in the order of their costs
    bool is_met = false;        ///< bake_to_error(): the interval lies below the error asked
    VertexBakeSeconds seconds;
};

/// Answers without values. occluders: in the mesh's frame; null: prepared for what occludes it
/// (Mesh::occluding). Of a share (settings.share of `engine`) those that it asks. forget: as in
/// solve(). Throws as prepare() and solve(), and Cancelled where progress says so.
[[nodiscard]] VertexBake solve_vertices(const Mesh& mesh, const VertexTarget& target,
                                        const EngineSettings& engine,
                                        const StageProgress& progress = {},
                                        Occluders* occluders = nullptr,
                                        const ForgetReceivers& forget = {});

/// With values of all answers, and their error; the target's receivers are not needed any more.
/// check: points of the statement of error; 0: none. The values are the same whatever it is.
[[nodiscard]] VertexBake bake_answers(const Mesh& mesh, const VertexTarget& target,
                                      VertexBake solved, const Offset& offset, std::uint32_t check,
                                      const StageProgress& progress = {});

/// Both, one after the other.
[[nodiscard]] VertexBake bake_vertices(const Mesh& mesh, const VertexTarget& target,
                                       const EngineSettings& engine, const Offset& offset,
                                       std::uint32_t check, const StageProgress& progress = {});

/// By the cheapest of masks at any quality and rays at any number whose error is below `error` with
/// its whole interval. Costs are those that settings have on the median model, so that equal input
/// takes the same one everywhere. Where values at these vertices cannot be so exact, whoever
/// answers (the floor's own interval does not lie below `error`), the bake is that of masks at
/// good, and is_met false. engine: definition and instructions are taken. check >= 1.
[[nodiscard]] VertexBake bake_to_error(const Mesh& mesh, const VertexTarget& target,
                                       const EngineSettings& engine, const Offset& offset,
                                       double error, std::uint32_t check,
                                       const StageProgress& progress = {},
                                       Occluders* occluders = nullptr);

}  // namespace surfelao
