#include "cli/pixel_options.h"

#include "cli/commands.h"
#include "cli/value_checks.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace surfelao {
namespace {

constexpr int kMostTaps = 4096;
constexpr double kMostGuard = 100.0;  // per cent: nine times the picture's pixels

/// "hbao.bias=30": the method is empty where none is named.
struct SetParameter {
    std::string method, name, value;
};

SetParameter parameter_of(const std::string& text)
{
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UsageError("--set: \"" + text + "\" is not NAME=VALUE or METHOD.NAME=VALUE.");
    SetParameter set{"", text.substr(0, equals), text.substr(equals + 1)};
    if (const std::size_t dot = set.name.find('.'); dot != std::string::npos) {
        set.method = set.name.substr(0, dot);
        set.name.erase(0, dot + 1);
    }
    return set;
}

/// "AO of screen methods: bias (hbao): degrees": a line for each parameter.
std::string parameters_text()
{
    std::string text;
    for (const ScreenParameter& parameter : screen_parameters()) {
        text += text.empty() ? ": " : "; ";
        text += std::string(parameter.name) + " = " + std::string(parameter.meaning);
    }
    return text;
}

/// The kind of engine as a sentence wants it.
bool is_screen_method(const std::string& name)
{
    return screen_method_of(name).has_value();
}

}  // namespace

std::vector<std::string> pixel_engine_names()
{
    std::vector<std::string> names = {"masks", "disks", "rays", "grid"};
    for (const ScreenMethod method : screen_methods())
        names.push_back(name_of(method));
    return names;
}

void add_pixel_options(CLI::App& command, PixelOptions& options, bool many_taps)
{
    constexpr const char* kGroup = "Pixels (--at pixels)";
    CLI::Option* taps =
        command
            .add_option("--taps", options.taps,
                        many_taps ? "Reads of the picture a pixel, of methods that know it alone; "
                                    "a row for each number"
                                  : "Reads of the picture a pixel, of methods that know it alone")
            ->check(whole_from(1, kMostTaps))
            ->type_name(many_taps ? "N,..." : "N")
            ->default_str(many_taps ? "8,16,24" : "24")
            ->group(kGroup);
    if (many_taps)
        taps->delimiter(',')->allow_extra_args(false);
    else
        taps->expected(1);
    command
        .add_option("--set", options.set,
                    "A setting of such a method; may be given again" + parameters_text())
        ->allow_extra_args(false)
        ->type_name("[METHOD.]NAME=VALUE")
        ->group(kGroup);
    command
        .add_option("--guard", options.guard,
                    "Such methods see that much more beyond each edge, in % of the picture's "
                    "height")
        ->type_name("P%")
        ->default_str("0%")
        ->group(kGroup);
}

bool is_at_pixels(const TexelOptions& options)
{
    return options.at == "pixels";
}

bool is_at_cube_maps(const TexelOptions& options)
{
    return options.at == "cubemaps";
}

std::vector<ScreenSettings> screen_settings_of(ScreenMethod method, const PixelOptions& options)
{
    std::vector<int> taps = options.taps;
    if (taps.empty())
        taps.push_back(ScreenSettings().samples);
    std::vector<ScreenSettings> all;
    for (const int samples : taps) {
        ScreenSettings& settings = all.emplace_back(screen_settings(method, samples));
        try {
            for (const std::string& text : options.set) {
                const SetParameter set = parameter_of(text);
                if (set.method.empty() || set.method == name_of(method))
                    set_parameter(settings, set.name, set.value);
            }
            check_settings(settings);
        } catch (const SettingsError& error) {
            throw UsageError("--engine " + name_of(method) + ": " + error.what() + ".");
        }
    }
    return all;
}

PixelEngine pixel_engine_of(const EngineOptions& engine, const PixelOptions& options)
{
    if (engine.engine == "grid")
        throw UsageError("--engine grid is for render and compare.");
    const auto method = screen_method_of(engine.engine.value_or("masks"));
    if (!method) {
        if (!options.taps.empty() || !options.set.empty() || options.guard)
            throw UsageError(
                "--taps, --set and --guard are for --engine ssao-disc, ssao-sphere, "
                "vo, hbao, gtao or bitmask.");
        return settings_of(engine);
    }
    if (engine.device || engine.quality || engine.rays || engine.passes || engine.strength)
        throw UsageError(
            "--device, --quality, --rays, --passes and --strength are for --engine "
            "masks, disks or rays: " +
            name_of(*method) + " has --taps and --set.");
    return screen_settings_of(*method, options).front();
}

void check_pixel_options(std::span<const std::string> engines, const PixelOptions& options,
                         const TexelOptions& texels, const MeasureOptions& measure)
{
    const auto screen = std::ranges::find_if(engines, is_screen_method);
    if (is_at_cube_maps(texels) && options.guard)
        throw UsageError("--guard is for --at pixels: a cube map's faces see no more.");
    if (!is_at_pixels(texels) && !is_at_cube_maps(texels)) {
        if (screen != engines.end())
            throw UsageError("--engine " + *screen + " is for --at pixels or cubemaps.");
        if (!options.taps.empty() || !options.set.empty() || options.guard)
            throw UsageError("--taps, --set and --guard are for --at pixels.");
        return;
    }
    for (const std::string& text : options.set) {
        const std::string method = parameter_of(text).method;
        if (!method.empty() && std::ranges::find(engines, method) == engines.end())
            throw UsageError("--set " + text + " is for --engine " + method + ".");
    }
    if (screen == engines.end())
        return;
    if (measure.ground)
        throw UsageError("--ground is for --engine masks, disks or rays: " + *screen +
                         " knows only what is seen.");
    if (kernel_of(measure) != Kernel::cosine)
        throw UsageError("--kernel bunnell is only for --engine disks or rays.");
}

double guard_share_of(const PixelOptions& options)
{
    if (!options.guard)
        return 0.0;
    std::string_view digits = *options.guard;
    double percent = 0.0;
    const bool has_unit = digits.ends_with('%');
    digits.remove_suffix(has_unit ? 1 : 0);
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), percent);
    if (!has_unit || error != std::errc() || end != digits.data() + digits.size() ||
        !(percent >= 0.0 && percent <= kMostGuard))
        throw UsageError("--guard: \"" + *options.guard + "\" is not a number from 0% to " +
                         exact(kMostGuard) + "%.");
    return percent / 100.0;
}

int guard_of(const PixelOptions& options, PictureSize size)
{
    return static_cast<int>(std::lround(guard_share_of(options) * size.height));
}

}  // namespace surfelao
