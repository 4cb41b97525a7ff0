#include "cli/texel_options.h"

#include "cli/commands.h"
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
        .add_option(
            "--at", options.at,
            "Where: vertices, or texels of a map over the file's texture coordinates, which "
            "a glTF gets as its occlusionTexture (default: texels for pictures)")
        ->check(CLI::IsMember({"vertices", "texels"}))
        ->type_name("vertices|texels")
        ->group(group);
    command.add_option("--size", options.size, "Texels of each side of the map")
        ->check(CLI::Range(1u, kMostTexels))
        ->type_name("N")
        ->default_str("1024")
        ->group(group);
    command
        .add_option("--uv", options.uv,
                    "The file's texture coordinates: by number, or the first of use")
        ->check(CLI::IsMember({"auto", "0", "1", "2", "3"}))
        ->type_name("auto|0|1|2|3")
        ->default_str("auto")
        ->group(group);
    command
        .add_option("--padding", options.padding,
                    "Texels around what is covered that go on with it; the others hold the mean")
        ->check(CLI::Range(0u, kMostPadding))
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
        ->check(CLI::IsMember({8, 16, 32}))
        ->type_name("8|16|32")
        ->default_str("8, .exr 32")
        ->group(kGroup);
    command
        .add_option("--bent", options.bent,
                    "world: bent normals too, as NAME.bent.png, (n + 1) / 2")
        ->check(CLI::IsMember({"none", "world"}))
        ->type_name("none|world")
        ->default_str("none")
        ->group(kGroup);
}

std::optional<TexelSettings> texel_settings_of(const TexelOptions& options,
                                               const std::filesystem::path& output)
{
    const bool picture = is_picture(output);
    if (picture && options.at == "vertices")
        throw UsageError("--at vertices needs a mesh file to write to, no picture.");
    if (!picture && options.at != "texels") {
        if (options.size || options.uv || options.padding || options.depth || options.bent)
            throw UsageError(
                "--size, --uv, --padding, --depth and --bent are for maps: -o NAME.png or --at "
                "texels.");
        return {};
    }
    TexelSettings settings;
    settings.size = options.size.value_or(settings.size);
    if (options.uv && *options.uv != "auto")
        settings.uv_set = static_cast<std::uint32_t>(std::stoul(*options.uv));
    settings.padding = options.padding.value_or(settings.padding);
    const int depth = options.depth.value_or(lower_extension(output) == ".exr" ? 32 : 8);
    settings.depth = depth == 8 ? MapDepth::byte : depth == 16 ? MapDepth::half : MapDepth::whole;
    settings.bent = options.bent == "world";
    return settings;
}

}  // namespace surfelao
