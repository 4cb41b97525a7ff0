#include "gpu/screen_space.h"

#include "surfels/errors.h"

#include <array>

namespace surfelao {
namespace {

struct MethodName {
    ScreenMethod method;
    std::string_view name;
};
constexpr std::array<MethodName, 6> kMethods = {{{ScreenMethod::ssao_disc, "ssao-disc"},
                                                 {ScreenMethod::ssao_sphere, "ssao-sphere"},
                                                 {ScreenMethod::vo, "vo"},
                                                 {ScreenMethod::hbao, "hbao"},
                                                 {ScreenMethod::gtao, "gtao"},
                                                 {ScreenMethod::bitmask, "bitmask"}}};
constexpr std::array<ScreenMethod, 6> kAll = {ScreenMethod::ssao_disc, ScreenMethod::ssao_sphere,
                                              ScreenMethod::vo,        ScreenMethod::hbao,
                                              ScreenMethod::gtao,      ScreenMethod::bitmask};

}  // namespace

std::string name_of(ScreenMethod method)
{
    for (const MethodName& named : kMethods) {
        if (named.method == method)
            return std::string(named.name);
    }
    SURFELAO_CHECK(false);
}

std::optional<ScreenMethod> screen_method_of(std::string_view name)
{
    for (const MethodName& named : kMethods) {
        if (named.name == name)
            return named.method;
    }
    return {};
}

std::span<const ScreenMethod> screen_methods()
{
    return kAll;
}

std::string setting_of(const ScreenSettings& settings)
{
    return std::to_string(settings.samples) + " samples";
}

ScreenSettings screen_settings(ScreenMethod method, int samples)
{
    ScreenSettings settings{.method = method, .samples = samples};
    settings.directions = samples < 24 ? 4 : 6;
    return settings;
}

std::span<const ScreenParameter> screen_parameters()
{
    return {};
}

void set_parameter(ScreenSettings& settings, std::string_view name, std::string_view)
{
    throw SettingsError(name_of(settings.method) + " has no setting \"" + std::string(name) + "\"");
}

void check_settings(const ScreenSettings&)
{
}

}  // namespace surfelao
