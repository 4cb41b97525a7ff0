#include "cli/view_options.h"

#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/value_checks.h"
#include "reference/rays.h"

#include <CLI/CLI.hpp>

#include <array>
#include <string_view>
#include <utility>

namespace surfelao {
namespace {

constexpr std::array<std::pair<std::string_view, Colors>, 11> kModes = {{
    {"visibility", Colors::visibility},
    {"rays", Colors::rays},
    {"difference", Colors::difference},
    {"bent-normals", Colors::bent_normals},
    {"normals", Colors::normals},
    {"levels", Colors::levels},
    {"environment", Colors::environment},
    {"charts", Colors::charts},
    {"density", Colors::density},
    {"textured", Colors::textured},
    {"coverage", Colors::coverage},
}};

constexpr std::array<std::pair<std::string_view, Shape>, 4> kSurfaces = {{
    {"triangles", Shape::triangles},
    {"splats", Shape::splats},
    {"affine", Shape::affine},
    {"points", Shape::points},
}};

template <class Table>
auto value_of(const Table& table, std::string_view name)
{
    for (const auto& [known, value] : table) {
        if (known == name)
            return value;
    }
    throw UsageError("\"" + std::string(name) + "\" is not known.");
}

template <class Table>
std::vector<std::string> names_of(const Table& table)
{
    std::vector<std::string> names;
    for (const auto& entry : table)
        names.emplace_back(entry.first);
    return names;
}

}  // namespace

void add_show_options(CLI::App& command, ShowOptions& options)
{
    command
        .add_option(
            "--mode", options.mode,
            "What the colours tell: visibility = 1 - occlusion; rays = the same by ray "
            "casting; difference = to rays, as a heat map; bent-normals; normals at "
            "corners, or of the disks; levels = depth in the octree; environment = light "
            "of a panorama; charts, density = of a map (--at texels): a colour for each "
            "chart, texels "
            "per unit of length; textured = the file's base colours times visibility; coverage = "
            "of cube maps (--at cubemaps): red where none answers")
        ->check(one_of(names_of(kModes)))
        ->type_name("MODE")
        ->default_str("visibility")
        ->group("Picture");
    command
        .add_option("--surface", options.surface,
                    "What is drawn: triangles; splats = surfels as disks, blended; affine = disks "
                    "by affine projection; points = plain point sprites")
        ->check(one_of(names_of(kSurfaces)))
        ->type_name("triangles|splats|affine|points")
        ->capture_default_str()
        ->group("Picture");
    add_up_option(command, options.up, "Picture");
    command
        .add_option("--environment", options.environment,
                    "Light for --mode environment: a panorama (.hdr .exr .png .jpg); default: a "
                    "built-in sky")
        ->type_name("FILE")
        ->group("Picture");
    command
        .add_option("--exposure", options.exposure,
                    "For --mode environment: brighter by that many stops (-20 to 20)")
        ->check(number_from(-20.0, 20.0))
        ->type_name("EV")
        ->capture_default_str()
        ->group("Picture");
    command
        .add_option("--splat-radius", options.radius_scale,
                    "Factor on the radius of splats; 1 covers the surface (0.01 to 100)")
        ->check(number_from(0.01, 100.0))
        ->type_name("F")
        ->capture_default_str()
        ->group("Picture");
    command
        .add_option("--difference-scale", options.difference_scale,
                    "The difference that is shown hottest (0.0001 to 1)")
        ->check(number_from(0.0001, 1.0))
        ->type_name("D")
        ->capture_default_str()
        ->group("Picture");
    command
        .add_option("--reference-rays", options.reference_rays,
                    "Rays of the reference for each vertex, texel or pixel, an even number")
        ->check(whole_from(2, kMostRays))
        ->type_name("N")
        ->capture_default_str()
        ->group("Picture");
    command.add_flag("--no-ground", options.no_ground, "No shadow on the ground under the model")
        ->group("Picture");
}

ViewOptions view_options_of(const ShowOptions& options)
{
    ViewOptions view;
    if (options.mode)
        view.colors = value_of(kModes, *options.mode);
    else if (options.environment)
        view.colors = Colors::environment;
    if (options.environment && view.colors != Colors::environment)
        throw UsageError("--environment is only for --mode environment.");
    if (options.reference_rays % 2 != 0)
        throw UsageError("--reference-rays must be an even number.");
    view.surface = value_of(kSurfaces, options.surface);
    if (view.colors == Colors::textured && view.surface != Shape::triangles)
        throw UsageError("--mode textured is for --surface triangles.");
    view.exposure = options.exposure;
    view.radius_scale = options.radius_scale;
    view.difference_scale = options.difference_scale;
    view.ground = !options.no_ground;
    return view;
}

void check_shown_map(const ViewOptions& view, bool has_map, bool atlas)
{
    if (!has_map && atlas)
        throw UsageError("--atlas is for --at texels.");
    if (!has_map && needs_map(view.colors))
        throw UsageError("--mode charts and density are for --at texels.");
    if (needs_cube_maps(view.colors))
        throw UsageError("--mode coverage is for --at cubemaps.");
    if (has_map && view.surface != Shape::triangles)
        throw UsageError("--at texels is for --surface triangles.");
    if (has_map && view.colors == Colors::levels)
        throw UsageError("--mode levels is for --at vertices.");
}

void check_shown_pixels(const ViewOptions& view, bool atlas, bool has_cube_maps)
{
    if (needs_cube_maps(view.colors) && !has_cube_maps)
        throw UsageError("--mode coverage is for --at cubemaps.");
    if (view.colors == Colors::bent_normals && has_cube_maps)
        throw UsageError("--mode bent-normals is not for --at cubemaps: maps hold none.");
    if (atlas)
        throw UsageError("--atlas is for --at texels.");
    if (needs_map(view.colors))
        throw UsageError("--mode charts and density are for --at texels.");
    if (view.colors == Colors::levels)
        throw UsageError("--mode levels is for --at vertices.");
    if (view.surface != Shape::triangles)
        throw UsageError("--at pixels and cubemaps are for --surface triangles.");
}

UpAxis up_axis_of(const ShowOptions& options)
{
    return options.up == "z" ? UpAxis::z : UpAxis::y;
}

}  // namespace surfelao
