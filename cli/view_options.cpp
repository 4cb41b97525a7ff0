#include "cli/view_options.h"

#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/value_checks.h"
#include "reference/rays.h"
#include "surfels/srgb.h"

#include <CLI/CLI.hpp>

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <utility>

namespace surfelao {
namespace {

constexpr std::array<std::pair<std::string_view, Colors>, 12> kModes = {{
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
    {"headlight", Colors::headlight},
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

/// "#RRGGBB" as a screen shows it, to linear; "white", "black".
glm::vec4 background_of(const std::string& text)
{
    if (text == "transparent")
        return glm::vec4(0.0f);
    const std::string digits = text == "white"   ? "ffffff"
                               : text == "black" ? "000000"
                               : text[0] == '#'  ? text.substr(1)
                                                 : "";
    std::uint32_t number = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
    if (digits.size() != 6 || error != std::errc() || end != digits.data() + digits.size())
        throw UsageError("--background is transparent, white, black or #RRGGBB, not \"" + text +
                         "\".");
    glm::vec4 color(1.0f);
    for (int c = 0; c < 3; ++c)
        color[c] = srgb_decode(static_cast<float>(number >> (16 - 8 * c) & 255u) / 255.0f);
    return color;
}

/// How numbers become colours.
void add_color_options(CLI::App& command, ShowOptions& options)
{
    command
        .add_option(
            "--difference-scale", options.difference_scale,
            "For --mode difference: the difference at the end of the colours (0.0001 to "
            "1); auto = what 95 % of the pixels stay below, rounded up to 1, 2 or 5 times a "
            "power of ten")
        ->check([is_number = number_from(0.0001, 1.0)](const std::string& text) {
            return text == "auto" ? std::string() : is_number(text);
        })
        ->type_name("D|auto")
        ->capture_default_str()
        ->group("Picture");
    command
        .add_flag("--signed", options.is_signed,
                  "For --mode difference: red is too dark, blue too bright, white right")
        ->group("Picture");
    command
        .add_option("--colormap", options.color_map,
                    "Colours of numbers: heat, viridis and inferno and grey rise evenly in "
                    "lightness; turbo tells most steps apart")
        ->check(one_of(names_of(kColorMaps)))
        ->type_name("NAME")
        ->capture_default_str()
        ->group("Picture");
}

}  // namespace

bool fits_scale(const ShowOptions& options)
{
    return options.difference_scale == "auto";
}

void add_show_options(CLI::App& command, ShowOptions& options)
{
    command
        .add_option(
            "--mode", options.mode,
            "What the colours tell: visibility = 1 - occlusion; rays = the same by ray "
            "casting; difference = to rays, in colours; bent-normals; normals at "
            "corners, or of the disks; levels = depth in the octree; environment = light "
            "of a panorama; charts, density = of a map (--at texels): a colour for each "
            "chart, texels "
            "per unit of length; textured = the file's base colours times visibility; coverage = "
            "of cube maps (--at cubemaps): red where none answers; headlight = a light at the "
            "camera times visibility")
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
    add_color_options(command, options);
    command
        .add_option("--background", options.background,
                    "What is behind the model: transparent, white, black or a colour as #RRGGBB; "
                    "default: a gradient, in --mode environment the panorama; at pixels: "
                    "transparent")
        ->type_name("COLOR")
        ->group("Picture");
    command
        .add_option("--reference-rays", options.reference_rays,
                    "Rays of the reference for each vertex, texel or pixel, an even number")
        ->check(whole_from(2, kMostRays))
        ->type_name("N")
        ->capture_default_str()
        ->group("Picture");
    command
        .add_flag("--wireframe", options.wireframe,
                  "The edges of triangles over what they show (not --at pixels, cubemaps)")
        ->group("Picture");
    command
        .add_flag("--cull", options.cull,
                  "Without triangles that show their back: a room seen from outside shows its "
                  "inside (not --at pixels, cubemaps)")
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
    const bool is_difference = view.colors == Colors::difference;
    if (options.is_signed && !is_difference)
        throw UsageError("--signed is for --mode difference.");
    if (fits_scale(options) && !is_difference)
        throw UsageError("--difference-scale auto is for --mode difference.");
    if (!fits_scale(options))
        view.difference_scale = std::stof(options.difference_scale);
    view.is_signed = options.is_signed;
    view.color_map = value_of(kColorMaps, options.color_map);
    if (options.background)
        view.background = background_of(*options.background);
    view.ground = !options.no_ground;
    view.wireframe = options.wireframe;
    view.cull = options.cull;
    if ((view.wireframe || view.cull) && view.surface != Shape::triangles)
        throw UsageError("--wireframe and --cull are for --surface triangles.");
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
    if (atlas && (view.colors == Colors::headlight || view.wireframe || view.cull))
        throw UsageError("--mode headlight, --wireframe and --cull show the model, not --atlas.");
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
