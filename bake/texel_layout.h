/// texel_layout.h: what is asked of a map, and where the surface then lies in it.
#pragma once

#include "atlas/layout.h"
#include "bake/vertex_target.h"
#include "files/scene_io.h"
#include "image/map.h"
#include "surfels/progress.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// Whose texture coordinates.
enum class UvChoice {
    automatic,  ///< the file's where they can hold a map, or one for each material (those of a map
                ///< that it has, else the first), else new ones where the output can
    file,       ///< set number `uv_set` of the file, whatever it looks like
    made,       ///< charts of our own
};

/// In which space the directions of a map of bent normals are.
enum class BentSpace { none, object, world, tangent };

struct TexelSettings {
    std::uint32_t size = 1024;  ///< of both sides, 1 to kMostTexels
    /// Charts of our own at this density, in texels per unit of the file, > 0: the size follows.
    std::optional<double> texels_per_unit = {};
    UvChoice uvs = UvChoice::automatic;
    std::uint32_t uv_set = 0;  ///< UvChoice::file: of Scene::uvs
    bool udim = false;         ///< the file's coordinates go over several tiles, a picture each
    bool blended = false;      ///< charts of our own overlap, one page for each axis
    std::uint32_t padding = 4;
    MapDepth depth = MapDepth::byte;
    BentSpace bent = BentSpace::none;  ///< bent normals too, as STEM.bent.png beside STEM.png
    bool green_down = false;           ///< tangent space: green grows down, as DirectX has it
    std::vector<std::filesystem::path> high = {};  ///< what is asked in place of the mesh itself
    std::optional<Length> cage = {};               ///< high_to_low.h; empty: kCageShare
    bool operator==(const TexelSettings&) const = default;
};

/// "at=texels size=1024 uv=auto ...": for marks.
[[nodiscard]] std::string text_of(const TexelSettings& settings);

/// What is told of charts of our own (atlas/atlas.h).
struct ChartReport {
    std::uint32_t count = 0;
    double use = 0.0;
    double seam_length = 0.0;
    double mean_stretch = 1.0, largest_stretch = 1.0;
    double texels_per_unit = 0.0;
};

struct TexelLayout {
    MapLayout layout;
    std::optional<std::uint32_t> uv_set;  ///< the file's; empty: new ones
    std::optional<ChartReport> charts;    ///< of new ones
    std::string why_new;                  ///< what the file's coordinates lack; or empty
};

/// What the output can hold beside one map over the file's coordinates.
struct MapRoom {
    bool new_places = true;     ///< texture coordinates of ours
    bool several_pages = true;  ///< a map for each material
};

/// Where the file's coordinates lie on each other, but those of each material by itself do not (as
/// game models have it), each material gets a page of this size; UvChoice::file and outputs without
/// room for new places take that also where mirrored pieces of one material lie on each other.
/// Throws InputError where the file has no coordinates of use and new ones are not possible,
/// SettingsError for what is out of its range.
[[nodiscard]] TexelLayout layout_for(const Mesh& mesh, const TexelSettings& settings,
                                     const MapRoom& room = {}, const Progress& progress = {});

/// What the writers of meshes take: pages, one for each of the layout, which is not blended and is
/// of the file's set `uv_set`, or new.
[[nodiscard]] OcclusionMap occlusion_map_of(const MapLayout& layout,
                                            std::optional<std::uint32_t> uv_set,
                                            std::span<const Map> pages, MapDepth depth);

}  // namespace surfelao
