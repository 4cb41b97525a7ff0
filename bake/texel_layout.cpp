#include "bake/texel_layout.h"

#include "atlas/atlas.h"
#include "atlas/udim.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"
#include "surfels/texels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

/// A set whose triangles overlap on more of the covered texels than this is for tiles or mirrored
/// halves; what is below is rounding at borders.
constexpr double kMostOverlap = 0.001;
/// Of the surface: what may have no place in the map.
constexpr double kMostWithoutPlace = 1e-4;
/// Texels of a side at which a set is examined: more find no other overlap.
constexpr std::uint32_t kExamined = 1024;

std::string set_text(std::uint32_t set)
{
    return "the texture coordinates of number " + std::to_string(set);
}

/// Why no map lies over these coordinates at all; empty where one does.
std::string fault_of(const Mesh& mesh, std::uint32_t set, MapSize size)
{
    const MapRaster raster(mesh.geometry, mesh.scene.uvs[set], size);
    if (raster.sheets() > kMostSheets)
        return set_text(set) + " cover the map " + fixed(raster.sheets(), 0) +
               " times over: no map can hold that";
    if (raster.flat_triangles() == mesh.geometry.triangles.size())
        return "no triangle has an area in " + set_text(set);
    return {};
}

/// What keeps each point of the surface from having texels of its own; empty where nothing does.
std::string lack_of(const Mesh& mesh, std::uint32_t set, std::uint32_t size)
{
    const std::uint32_t side = std::min(size, kExamined);
    if (std::string fault = fault_of(mesh, set, {side, side}); !fault.empty())
        return fault;
    const MapRaster raster(mesh.geometry, mesh.scene.uvs[set], {side, side});
    std::vector<std::uint8_t> shown(mesh.geometry.triangles.size(), 0);
    raster.mark_shown(shown);
    const std::vector<double> areas = triangle_areas(mesh.geometry);
    double whole = 0.0, missing = 0.0;
    for (std::size_t t = 0; t < areas.size(); ++t) {
        whole += areas[t];
        missing += shown[t] ? 0.0 : areas[t];
    }
    if (missing > kMostWithoutPlace * whole)
        return fixed(100.0 * missing / whole, 1) + " % of the surface have no place in " +
               set_text(set);
    std::uint64_t covered = 0, several = 0;
    const std::vector<Texel> texels = raster.texels(0, side);
    for (std::size_t first = 0, end = 0; first < texels.size(); first = end) {
        for (end = first + 1; end < texels.size() && texels[end].x == texels[first].x &&
                              texels[end].y == texels[first].y;)
            ++end;
        ++covered;
        several += end - first > 1 ? 1 : 0;
    }
    if (static_cast<double>(several) > kMostOverlap * static_cast<double>(covered))
        return set_text(set) + " lie on each other at " +
               fixed(100.0 * static_cast<double>(several) / static_cast<double>(covered), 1) +
               " % of the texels";
    return {};
}

/// The set of the map that the file has already, else the first that has something; empty where
/// none has.
std::optional<std::uint32_t> first_set(const Scene& scene)
{
    if (const auto set = scene.asset ? scene.asset->occlusion_uvs() : std::nullopt;
        set && *set < scene.uvs.size() && !scene.uvs[*set].empty())
        return set;
    for (std::uint32_t set = 0; set < scene.uvs.size(); ++set)
        if (!scene.uvs[set].empty())
            return set;
    return {};
}

}  // namespace

std::string text_of(const TexelSettings& settings)
{
    std::string text = "at=texels ";
    if (settings.texels_per_unit)
        append_shortest(text += "texels_per_unit=", *settings.texels_per_unit);
    else
        text += "size=" + std::to_string(settings.size);
    text += " uv=";
    text += settings.uvs == UvChoice::automatic ? "auto"
            : settings.uvs == UvChoice::made    ? "new"
                                                : std::to_string(settings.uv_set);
    text += settings.udim ? " udim" : "";
    text += settings.blended ? " charts=blended" : "";
    text += " padding=" + std::to_string(settings.padding);
    text += settings.depth == MapDepth::byte   ? " depth=8"
            : settings.depth == MapDepth::half ? " depth=16"
                                               : " depth=32";
    constexpr const char* kSpaces[] = {"", " bent=object", " bent=world", " bent=tangent"};
    text += kSpaces[static_cast<int>(settings.bent)];
    text += settings.green_down ? " green=-y" : "";
    for (const std::filesystem::path& high : settings.high)
        text += " high=" + high.filename().string();
    if (settings.cage) {
        append_shortest(text += " cage=", settings.cage->value);
        text += settings.cage->percent ? "%" : "";
    }
    return text;
}

TexelLayout layout_for(const Mesh& mesh, const TexelSettings& settings, bool can_hold_new,
                       const Progress& progress)
{
    const std::vector<UvSet>& sets = mesh.scene.uvs;
    const auto fail = [&](const std::string& fault) {
        throw InputError(mesh.scene.name + ": " + fault);
    };
    const MapSize size{settings.size, settings.size};
    TexelLayout found;
    if (settings.uvs != UvChoice::made) {
        found.uv_set = settings.uvs == UvChoice::file ? settings.uv_set : first_set(mesh.scene);
        const bool is_there =
            found.uv_set && *found.uv_set < sets.size() && !sets[*found.uv_set].empty();
        if (settings.uvs == UvChoice::file && !is_there)
            fail("has no texture coordinates of number " + std::to_string(settings.uv_set));
        if (!is_there)
            found.why_new = "there are no texture coordinates";
        else if (settings.udim)
            found.layout = udim_layout(mesh.scene, sets[*found.uv_set], size);
        else if (settings.uvs == UvChoice::automatic && can_hold_new)
            found.why_new = lack_of(mesh, *found.uv_set, settings.size);
        if (settings.udim && is_there && found.layout.pages.empty())
            fail(set_text(*found.uv_set) + " lie on no UDIM tile");
    }
    const bool wants_new = settings.uvs == UvChoice::made || !found.why_new.empty();
    if (wants_new && !can_hold_new)
        fail(
            "has no texture coordinates for a map; -o a .glb, .gltf, .obj or .ply with --at "
            "texels makes some");
    if (wants_new) {
        found.uv_set.reset();
        Atlas atlas = make_atlas(mesh,
                                 {.size = settings.size,
                                  .texels_per_unit = settings.texels_per_unit,
                                  .padding = settings.padding,
                                  .blended = settings.blended},
                                 progress);
        found.charts = {atlas.chart_count,     atlas.use,
                        atlas.seam_length,     atlas.mean_stretch,
                        atlas.largest_stretch, atlas.texels_per_unit};
        found.layout = std::move(atlas.layout);
    } else if (found.layout.pages.empty()) {
        if (const std::string fault = fault_of(mesh, *found.uv_set, {1, 1}); !fault.empty())
            fail(fault);
        found.layout = {.size = size, .pages = {sets[*found.uv_set]}};
    }
    return found;
}

}  // namespace surfelao
