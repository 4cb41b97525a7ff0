#include "pixels/grid_sources.h"

#include "bake/moving_poses.h"
#include "grid/grid_file.h"
#include "surfels/errors.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

/// The part alone that the grid was baked of (bake --receivers); empty where it is not one.
std::string node_named_by(const GridNotes& notes)
{
    const nlohmann::json about = nlohmann::json::parse(notes.about, nullptr, false);
    const nlohmann::json::json_pointer where("/parts/receivers");
    if (!about.is_object() || !about.contains(where))
        return {};
    const nlohmann::json& names = about.at(where);
    return names.is_array() && names.size() == 1 && names[0].is_string()
               ? names[0].get<std::string>()
               : std::string();
}

/// What one body's parts are called.
std::string body_name(const Scene& scene, const std::vector<std::uint32_t>& bodies,
                      std::uint32_t body)
{
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
        if (bodies[p] == body && !scene.parts[p].name.empty())
            return scene.parts[p].name;
    }
    return "body " + std::to_string(body);
}

}  // namespace

GridSources read_grids(const std::filesystem::path& input, const ReadOptions& reading,
                       std::span<const GridFile> files)
{
    GridSources sources;
    for (const GridFile& file : files) {
        GridNotes notes;
        auto grid = std::make_shared<const AoGrid>(read_grid(file.path, &notes));
        const std::string node = file.node.empty() ? node_named_by(notes) : file.node;
        if (node.empty())
            throw InputError(file.path.string() +
                             ": names no node whose grid it is: NODE=FILE says it");
        sources.grids.push_back({node, std::move(grid)});
    }
    if (reading.moment)
        sources.motion =
            std::make_shared<const Motion>(read_rest(input, reading), reading.moment->animation);
    return sources;
}

GridSources bake_moving_grids(const std::filesystem::path& input, const ReadOptions& reading,
                              const GridSettings& settings, const EngineSettings& engine,
                              const StageProgress& progress)
{
    GridSettings of_one = settings;
    of_one.extent *= kMovingShare;
    const Scene rest = read_rest(input, reading);
    if (animations_of(rest).empty())
        throw InputError(rest.name +
                         ": nothing in it moves: --grid NODE=FILE tells whose grids there are");
    GridSources sources;
    sources.motion = std::make_shared<const Motion>(
        rest, reading.moment ? reading.moment->animation : std::string());
    const std::vector<std::uint32_t>& bodies = sources.motion->bodies();
    const std::vector<bool>& deforms = sources.motion->deforms();
    const std::uint32_t count = sources.motion->body_count();
    for (std::uint32_t body = 1; body < count; ++body) {
        std::vector<bool> own(rest.triangles.size(), false);
        bool is_rigid = true;
        for (std::size_t p = 0; p < rest.parts.size(); ++p) {
            if (bodies[p] != body)
                continue;
            is_rigid = is_rigid && !deforms[p];
            std::fill_n(own.begin() + static_cast<std::ptrdiff_t>(rest.parts[p].first_triangle),
                        rest.parts[p].triangle_count, true);
        }
        if (!is_rigid || std::ranges::find(own, true) == own.end())
            continue;
        std::vector<bool> others = own;
        others.flip();
        const Geometry object = make_geometry(rest, {.left_out = std::move(others)});
        if (object.triangles.empty())
            continue;
        if (progress && !progress("grids", (body - 1.0) / count))
            throw Cancelled();
        GridBake baked = bake_grid(object, of_one, engine, 0);
        sources.grids.push_back({body_name(rest, bodies, body),
                                 std::make_shared<const AoGrid>(std::move(baked.grid)),
                                 std::move(own)});
    }
    if (sources.grids.empty())
        throw InputError(rest.name + ": nothing in it moves as one piece, which a grid needs");
    return sources;
}

}  // namespace surfelao
