#include "cli/texel_options.h"

#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/value_checks.h"
#include "surfels/extension.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace surfelao {
namespace {

/// Rings of texels around a chart: beyond this the mean of the map is as good.
constexpr std::uint32_t kMostPadding = 256;

bool is_picture(const std::filesystem::path& output)
{
    const std::string extension = lower_extension(output);
    return std::ranges::any_of(std::initializer_list<const char*>{".png", ".tif", ".tiff", ".exr"},
                               [&](const char* known) { return extension == known; });
}

}  // namespace

void add_layout_options(CLI::App& command, TexelOptions& options, const std::string& group)
{
    command
        .add_option("--at", options.at,
                    "Where occlusion is asked: vertices, texels of a map on the triangles, the "
                    "points of a file without faces (default: points there, else vertices; of "
                    "bake, texels for pictures), a grid of cells round an object (bake, "
                    "compare, view), and where it is not baked: pixels of the picture, or cube "
                    "maps inside of the "
                    "scene")
        ->check(one_of({"vertices", "texels", "points", "grid", "pixels", "cubemaps"}))
        ->type_name("vertices|texels|points|grid|pixels|cubemaps")
        ->group(group);
    command.add_option("--size", options.size, "Texels of each side of the map")
        ->check(whole_from(1, kMostTexels))
        ->type_name("N")
        ->default_str("1024")
        ->group(group);
    command
        .add_option("--texels-per-unit", options.texels_per_unit,
                    "Charts of our own at this density: the size follows")
        ->check(number_above_zero())
        ->type_name("D")
        ->excludes(command.get_option("--size"))
        ->group(group);
    command
        .add_option("--uv", options.uv,
                    "The file's texture coordinates by number; new ones, charts of our own; or "
                    "auto: the file's where each point of the surface has texels of its own, else "
                    "new ones (a picture alone: the first of use). Materials that lie over each "
                    "other get a map each (glTF; NAME.MATERIAL.png)")
        ->check(one_of({"auto", "0", "1", "2", "3", "new"}))
        ->type_name("auto|0|1|2|3|new")
        ->default_str("auto")
        ->group(group);
    command
        .add_option("--charts", options.charts,
                    "Of new coordinates. planar: each triangle in one chart; blended: a page for "
                    "each axis, which fade into each other (drawn by render and view)")
        ->check(one_of({"planar", "blended"}))
        ->type_name("planar|blended")
        ->default_str("planar")
        ->group(group);
    command
        .add_flag("--udim", options.udim,
                  "The file's coordinates go over several tiles: a picture each, NAME.1001.png "
                  "and so on")
        ->group(group);
    command
        .add_option("--padding", options.padding,
                    "Texels around what is covered that go on with it; the others hold the mean")
        ->check(whole_from(0, kMostPadding))
        ->type_name("N")
        ->default_str("4")
        ->group(group);
}

void add_texel_options(CLI::App& command, TexelOptions& options)
{
    constexpr const char* kGroup = "Maps (-o NAME.png, .tif, .exr, or --at texels)";
    add_layout_options(command, options, kGroup);
    command
        .add_option("--depth", options.depth,
                    "Bits of each number: .png 8, 16; .tif 8, 16, 32; .exr 16, 32 (floats)")
        ->check(one_of({"8", "16", "32"}))
        ->type_name("8|16|32")
        ->default_str("8, .exr 32")
        ->group(kGroup);
    command
        .add_option("--bent", options.bent,
                    "Bent normals too, as NAME.bent.png, (n + 1) / 2, in this space")
        ->check(one_of({"none", "object", "world", "tangent"}))
        ->type_name("none|object|world|tangent")
        ->default_str("none")
        ->group(kGroup);
    command
        .add_option("--green", options.green,
                    "Of --bent tangent: which way green grows: +y as in OpenGL and glTF, -y as in "
                    "DirectX")
        ->check(one_of({"+y", "-y"}))
        ->type_name("+y|-y")
        ->default_str("+y")
        ->group(kGroup);
    command
        .add_option("--high", options.high,
                    "Files of a finer mesh: what it shows is asked at the texels, and it alone "
                    "occludes; parts NAME_low look for NAME_high")
        ->type_name("FILE...")
        ->group(kGroup);
    command
        .add_option("--cage", options.cage,
                    "How far out from the mesh one looks for the finer one, and as far in: in the "
                    "file's units, or with % of its bounding box's diagonal")
        ->type_name("D|P%")
        ->default_str("2%")
        ->group(kGroup);
}

void add_atlas_option(CLI::App& command, bool& atlas)
{
    command
        .add_flag("--atlas", atlas,
                  "The map itself, flat, with the borders of its charts, in place of the model")
        ->group(kShownMaps);
}

namespace {

/// Whether an option was given that is of no use without a map.
bool has_texel_option(const TexelOptions& options)
{
    return options.size || options.texels_per_unit || options.uv || options.charts ||
           options.udim || options.padding || options.depth || options.bent || options.green ||
           !options.high.empty() || options.cage;
}

/// Throws UsageError for options that contradict each other.
void check_together(const TexelOptions& options, bool picture)
{
    const auto refuse = [](bool wrong, const char* sentence) {
        if (wrong)
            throw UsageError(sentence);
    };
    const bool own = options.uv == "new" || options.uv.value_or("auto") == "auto";
    refuse(picture && options.uv == "new",
           "--uv new makes texture coordinates, which a picture cannot hold: -o NAME.glb, .gltf, "
           ".obj or .ply.");
    refuse(options.texels_per_unit && (!own || picture),
           "--texels-per-unit is for texture coordinates that are made: -o a mesh, --uv new.");
    refuse(options.charts == "blended" && (!own || picture),
           "--charts is for texture coordinates that are made: -o a mesh, --uv new.");
    refuse(options.charts == "blended" && options.bent.value_or("none") != "none",
           "--bent is for maps of one page: --charts planar.");
    refuse(options.green && options.bent != "tangent", "--green is for --bent tangent.");
    refuse(options.cage && options.high.empty(), "--cage is for --high.");
}

/// Where the map lies.
TexelSettings layout_settings_of(const TexelOptions& options)
{
    TexelSettings settings;
    settings.size = options.size.value_or(settings.size);
    settings.texels_per_unit = options.texels_per_unit;
    if (options.uv == "new" || options.texels_per_unit || options.charts == "blended")
        settings.uvs = UvChoice::made;
    else if (options.uv && *options.uv != "auto") {
        settings.uvs = UvChoice::file;
        settings.uv_set = static_cast<std::uint32_t>(std::stoul(*options.uv));
    }
    settings.udim = options.udim;
    settings.blended = options.charts == "blended";
    settings.padding = options.padding.value_or(settings.padding);
    return settings;
}

}  // namespace

std::optional<TexelSettings> texel_settings_of(const TexelOptions& options,
                                               const std::filesystem::path& output)
{
    if (options.at == "pixels" || options.at == "cubemaps")
        throw UsageError("--at " + *options.at + " is for render, compare and view.");
    if (options.at == "grid") {
        TexelOptions others = options;
        others.depth.reset();
        if (has_texel_option(others))
            throw UsageError("Of the options of maps only --depth is for --at grid.");
        return {};
    }
    const bool picture = is_picture(output);
    if (picture && (options.at == "vertices" || options.at == "points"))
        throw UsageError("--at " + *options.at + " needs a mesh file to write to, no picture.");
    if (!picture && options.at != "texels") {
        if (has_texel_option(options))
            throw UsageError(
                "Options of maps (--size, --uv, --padding, --bent, --high and so on) need -o "
                "NAME.png or --at texels.");
        return {};
    }
    check_together(options, picture);
    if (options.udim && !picture)
        throw UsageError("--udim is for pictures: -o NAME.png, .tif or .exr.");
    TexelSettings settings = layout_settings_of(options);
    const int depth = options.depth.value_or(lower_extension(output) == ".exr" ? 32 : 8);
    settings.depth = depth == 8 ? MapDepth::byte : depth == 16 ? MapDepth::half : MapDepth::whole;
    constexpr const char* kSpaces[] = {"none", "object", "world", "tangent"};
    for (int space = 0; space < 4; ++space)
        if (options.bent == kSpaces[space])
            settings.bent = static_cast<BentSpace>(space);
    settings.green_down = options.green == "-y";
    settings.high.assign(options.high.begin(), options.high.end());
    if (options.cage)
        settings.cage = length_of(*options.cage, "--cage");
    return settings;
}

std::optional<TexelSettings> shown_texels_of(const TexelOptions& options)
{
    if (options.at == "texels") {
        check_together(options, false);
        return layout_settings_of(options);
    }
    if (has_texel_option(options))
        throw UsageError("--size, --uv, --charts, --udim and --padding are for --at texels.");
    return {};
}

}  // namespace surfelao
