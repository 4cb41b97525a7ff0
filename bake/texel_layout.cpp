#include "bake/texel_layout.h"

#include "atlas/atlas.h"
#include "atlas/material_pages.h"
#include "atlas/udim.h"
#include "image/image_file.h"
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
/// More materials share a page: each takes the time of a map.
constexpr std::size_t kMostMaterialPages = 16;
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

/// How the surface lies on the pages of a layout.
struct PageUse {
    double missing = 0.0;  ///< share of the surface that has no place
    double several = 0.0;  ///< share of the covered texels that show several places
};

PageUse use_of(const Mesh& mesh, std::span<const UvSet> pages, std::uint32_t side)
{
    std::vector<std::uint8_t> shown(mesh.geometry.triangles.size(), 0);
    std::uint64_t covered = 0, several = 0;
    for (const UvSet& page : pages) {
        const MapRaster raster(mesh.geometry, page, {side, side});
        raster.mark_shown(shown);
        const std::vector<Texel> texels = raster.texels(0, side);
        for (std::size_t first = 0, end = 0; first < texels.size(); first = end) {
            for (end = first + 1; end < texels.size() && texels[end].x == texels[first].x &&
                                  texels[end].y == texels[first].y;)
                ++end;
            ++covered;
            several += end - first > 1 ? 1 : 0;
        }
    }
    const std::vector<double> areas = triangle_areas(mesh.geometry);
    double whole = 0.0, missing = 0.0;
    for (std::size_t t = 0; t < areas.size(); ++t) {
        whole += areas[t];
        missing += shown[t] ? 0.0 : areas[t];
    }
    return {missing / whole, static_cast<double>(several) /
                                 static_cast<double>(std::max<std::uint64_t>(1, covered))};
}

/// What keeps each point of the surface from having texels of its own; empty where nothing does.
std::string lack_of(const Mesh& mesh, std::uint32_t set, std::uint32_t size)
{
    const std::uint32_t side = std::min(size, kExamined);
    if (std::string fault = fault_of(mesh, set, {side, side}); !fault.empty())
        return fault;
    const PageUse use = use_of(mesh, std::span(&mesh.scene.uvs[set], 1), side);
    if (use.missing > kMostWithoutPlace)
        return fixed(100.0 * use.missing, 1) + " % of the surface have no place in " +
               set_text(set);
    if (use.several > kMostOverlap)
        return set_text(set) + " lie on each other at " + fixed(100.0 * use.several, 1) +
               " % of the texels";
    return {};
}

/// A page for each material, where no more than `most` of the texels then show several places;
/// without pages where that is not so, or there is one material, or more than a few.
MapLayout layout_by_material(const Mesh& mesh, std::uint32_t set, MapSize size, double most)
{
    if (!mesh.scene.asset)
        return {};
    const BaseColors colors = mesh.scene.asset->base_colors();
    if (colors.materials.size() < 2)
        return {};
    const std::uint32_t side = std::min(size.width, kExamined);
    MapLayout layout = material_layout(mesh.scene, mesh.scene.uvs[set], colors, size);
    if (layout.pages.size() < 2 || layout.pages.size() > kMostMaterialPages)
        return {};
    for (const UvSet& page : layout.pages)
        if (MapRaster(mesh.geometry, page, {side, side}).sheets() > kMostSheets)
            return {};
    const PageUse use = use_of(mesh, layout.pages, side);
    return use.missing <= kMostWithoutPlace && use.several <= most ? layout : MapLayout{};
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

TexelLayout layout_for(const Mesh& mesh, const TexelSettings& settings, const MapRoom& room,
                       const Progress& progress)
{
    const std::vector<UvSet>& sets = mesh.scene.uvs;
    const auto fail = [&](const std::string& fault) {
        const std::string& name = mesh.scene.name;
        throw InputError(name.empty() ? fault : name + ": " + fault);
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
        else
            found.why_new = lack_of(mesh, *found.uv_set, settings.size);
        if (is_there && !settings.udim && !found.why_new.empty()) {
            // who insists on the file's coordinates gets the mean where they lie on each other
            const bool insists = settings.uvs == UvChoice::file || !room.new_places;
            if (room.several_pages)
                found.layout =
                    layout_by_material(mesh, *found.uv_set, size, insists ? 1.0 : kMostOverlap);
            if (!found.layout.pages.empty() || insists)
                found.why_new.clear();
        }
        if (settings.udim && is_there && found.layout.pages.empty())
            fail(set_text(*found.uv_set) + " lie on no UDIM tile");
    }
    const bool wants_new = settings.uvs == UvChoice::made || !found.why_new.empty();
    if (wants_new && !room.new_places)
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

OcclusionMap occlusion_map_of(const MapLayout& layout, std::optional<std::uint32_t> uv_set,
                              std::span<const Map> pages, MapDepth depth)
{
    OcclusionMap map{map_bytes(pages[0], depth), uv_set.value_or(0)};
    const std::vector<UvSet>& places = layout.pages;
    if (!uv_set)
        map.uvs = places[0];
    if (pages.size() > 1)
        map.pages.resize(places[0].corners.size(), 0);
    for (std::uint32_t page = 1; page < pages.size(); ++page) {
        map.more_pngs.push_back(map_bytes(pages[page], depth));
        for (std::size_t t = 0; t < map.pages.size(); ++t)
            if (places[page].corners[t].x != UvSet::kNone)
                map.pages[t] = page;
    }
    return map;
}

}  // namespace surfelao
