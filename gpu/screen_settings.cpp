#include "gpu/screen_space.h"

#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <variant>

namespace surfelao {
namespace {

using enum ScreenMethod;

struct MethodName {
    ScreenMethod method;
    std::string_view name;
};
constexpr std::array<MethodName, 6> kMethods = {{{ssao_disc, "ssao-disc"},
                                                 {ssao_sphere, "ssao-sphere"},
                                                 {vo, "vo"},
                                                 {hbao, "hbao"},
                                                 {gtao, "gtao"},
                                                 {bitmask, "bitmask"}}};
constexpr std::array<ScreenMethod, 6> kAll = {ssao_disc, ssao_sphere, vo, hbao, gtao, bitmask};

constexpr int kMostSamples = 4096;
constexpr double kEndlessThickness = std::numeric_limits<double>::infinity();

struct RealField {
    float ScreenSettings::*member;
    double low, high;
    bool above = false;  // low itself is out
};
struct WholeField {
    int ScreenSettings::*member;
    int low, high;
};
struct SwitchField {
    bool ScreenSettings::*member;
};
struct WordField {
    std::vector<std::string_view> words;
    std::size_t (*get)(const ScreenSettings&);
    void (*set)(ScreenSettings&, std::size_t);
};
using Field = std::variant<RealField, WholeField, SwitchField, WordField>;

constexpr std::array<int, 4> kProbeCounts = {4, 9, 20, 328};

WordField probe_field()
{
    return {{"4", "9", "20", "328"},
            [](const ScreenSettings& settings) {
                return static_cast<std::size_t>(std::ranges::find(kProbeCounts, settings.probes) -
                                                kProbeCounts.begin());
            },
            [](ScreenSettings& settings, std::size_t k) { settings.probes = kProbeCounts[k]; }};
}

WordField dual_field()
{
    return {
        {"none", "product", "minimum"},
        [](const ScreenSettings& settings) { return static_cast<std::size_t>(settings.dual); },
        [](ScreenSettings& settings, std::size_t k) { settings.dual = static_cast<DualRadii>(k); }};
}

WordField noise_field()
{
    return {{"none", "gradient", "origin"},
            [](const ScreenSettings& settings) { return static_cast<std::size_t>(settings.noise); },
            [](ScreenSettings& settings, std::size_t k) {
                settings.noise = static_cast<ScreenNoise>(k);
            }};
}

struct Row {
    ScreenParameter shown;
    std::string_view range;  // in a sentence: "NAME must be RANGE"
    Field field;
};

const std::vector<Row>& parameter_rows()
{
    using Settings = ScreenSettings;
    static const std::vector<ScreenMethod> every(kAll.begin(), kAll.end());
    static const std::vector<Row> rows = {
        {{"directions",
          "number, divides the samples; gtao, bitmask: even, two a slice",
          {hbao, gtao, bitmask}},
         "1 to 4096",
         WholeField{&Settings::directions, 1, kMostSamples}},
        {{"bias", "degrees, 0 to 90: horizons below it do not count", {hbao}},
         "0 to 90 degrees",
         RealField{&Settings::bias, 0.0, 90.0}},
        {{"thickness", "radii, above 0, or inf: how far what is seen reaches back", {bitmask}},
         "above 0",
         RealField{&Settings::thickness, 0.0, kEndlessThickness, true}},
        {{"power", "1 to 8: steps lie at the radius times (k / n)^power", {gtao, bitmask}},
         "1 to 8",
         RealField{&Settings::power, 1.0, 8.0}},
        {{"reach",
          "radii, above 0 to 1000: what is nearer to the eye by more says nothing",
          {ssao_disc, ssao_sphere, vo}},
         "above 0 and at most 1000 radii",
         RealField{&Settings::reach, 0.0, 1000.0, true}},
        {{"normals", "on, off: the tangent plane is the normal's, or the picture's", {hbao}},
         "on or off",
         SwitchField{&Settings::normals}},
        {{"fade", "on, off: with a hard limit, horizons fade towards it as published", {hbao}},
         "on or off",
         SwitchField{&Settings::fade}},
        {{"pairs", "on, off: each sample has one opposite of it", {ssao_disc, ssao_sphere, vo}},
         "on or off",
         SwitchField{&Settings::pairs}},
        {{"ratio-test",
          "on, off: what says nothing is told by the ratio of depths",
          {ssao_disc, ssao_sphere}},
         "on or off",
         SwitchField{&Settings::ratio_test}},
        {{"dual", "none, product, minimum: half the radius, too", {vo}},
         "none, product or minimum",
         dual_field()},
        {{"rule", "0 to 6: of the dynamic radius; 0 is none", {vo}},
         "0 to 6",
         WholeField{&Settings::rule, 0, 6}},
        {{"probes", "4, 9, 20, 328: of the rule", {vo}}, "4, 9, 20 or 328", probe_field()},
        {{"depth-limit", "radii, above 0 to 1000: of the rules 4 and 5", {vo}},
         "above 0 and at most 1000 radii",
         RealField{&Settings::depth_limit, 0.0, 1000.0, true}},
        {{"noise", "none, gradient, origin: how neighbouring pixels differ", every},
         "none, gradient or origin",
         noise_field()},
        {{"frame", "0 to 65535: each has other noise", every},
         "0 to 65535",
         WholeField{&Settings::frame, 0, 65535}},
        {{"blur", "on, off: the mean of 5 x 5 pixels of the same surface", every},
         "on or off",
         SwitchField{&Settings::blur}},
    };
    return rows;
}

bool knows(ScreenMethod method, const Row& row)
{
    return std::ranges::find(row.shown.methods, method) != row.shown.methods.end();
}

/// The whole text as a number.
template <class Number>
std::optional<Number> whole_number(std::string_view text)
{
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
        return {};
    return value;
}

/// A field read from a text: false where it is no value of it.
struct Reading {
    ScreenSettings& settings;
    std::string_view text;
    bool operator()(const RealField& field) const
    {
        const std::optional<float> value = whole_number<float>(text);
        settings.*field.member = value.value_or(0.0f);
        return value.has_value();
    }
    bool operator()(const WholeField& field) const
    {
        const std::optional<int> value = whole_number<int>(text);
        settings.*field.member = value.value_or(0);
        return value.has_value();
    }
    bool operator()(const SwitchField& field) const
    {
        settings.*field.member = text == "on";
        return text == "on" || text == "off";
    }
    bool operator()(const WordField& field) const
    {
        const auto found = std::ranges::find(field.words, text);
        if (found == field.words.end())
            return false;
        field.set(settings, static_cast<std::size_t>(found - field.words.begin()));
        return true;
    }
};

struct InRange {
    const ScreenSettings& settings;
    bool operator()(const RealField& field) const
    {
        const double value = static_cast<double>(settings.*field.member);
        return value <= field.high && (field.above ? value > field.low : value >= field.low);
    }
    bool operator()(const WholeField& field) const
    {
        return settings.*field.member >= field.low && settings.*field.member <= field.high;
    }
    bool operator()(const SwitchField&) const { return true; }
    bool operator()(const WordField& field) const
    {
        return field.get(settings) < field.words.size();
    }
};

/// "bias 30", "blur", "no normals"
struct Telling {
    std::string_view name;
    const ScreenSettings& settings;
    std::string operator()(const RealField& field) const
    {
        return std::string(name) + ' ' + significant(static_cast<double>(settings.*field.member));
    }
    std::string operator()(const WholeField& field) const
    {
        return std::string(name) + ' ' + std::to_string(settings.*field.member);
    }
    std::string operator()(const SwitchField& field) const
    {
        return (settings.*field.member ? "" : "no ") + std::string(name);
    }
    std::string operator()(const WordField& field) const
    {
        return std::string(name) + ' ' + std::string(field.words[field.get(settings)]);
    }
};

bool has_directions(ScreenMethod method)
{
    return method == hbao || method == gtao || method == bitmask;
}

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
    std::string text = std::to_string(settings.samples) + " samples";
    if (has_directions(settings.method))
        text = std::to_string(settings.directions) + " x " +
               std::to_string(settings.samples / settings.directions);
    const ScreenSettings usual = screen_settings(settings.method, settings.samples);
    for (const Row& row : parameter_rows()) {
        const std::string said = std::visit(Telling{row.shown.name, settings}, row.field);
        if (knows(settings.method, row) && row.shown.name != "directions" &&
            (row.shown.name == "bias" ||
             said != std::visit(Telling{row.shown.name, usual}, row.field)))
            text += ", " + said;
    }
    return text;
}

ScreenSettings screen_settings(ScreenMethod method, int samples)
{
    ScreenSettings settings{.method = method, .samples = samples, .directions = samples};
    for (int directions = 2; directions < samples; directions += 2) {
        if (samples % directions == 0 && directions * directions >= samples) {
            settings.directions = directions;
            break;
        }
    }
    return settings;
}

std::span<const ScreenParameter> screen_parameters()
{
    static const std::vector<ScreenParameter> shown = [] {
        std::vector<ScreenParameter> parameters;
        for (const Row& row : parameter_rows())
            parameters.push_back(row.shown);
        return parameters;
    }();
    return shown;
}

void set_parameter(ScreenSettings& settings, std::string_view name, std::string_view text)
{
    std::string known;
    for (const Row& row : parameter_rows()) {
        if (!knows(settings.method, row))
            continue;
        known += (known.empty() ? "" : ", ") + std::string(row.shown.name);
        if (row.shown.name != name)
            continue;
        ScreenSettings wished = settings;
        require(
            std::visit(Reading{wished, text}, row.field) && std::visit(InRange{wished}, row.field),
            std::string(name) + " of " + name_of(settings.method) + " must be " +
                std::string(row.range) + ", not '" + std::string(text) + "'");
        settings = wished;
        return;
    }
    throw SettingsError(name_of(settings.method) + " has no setting '" + std::string(name) +
                        "'; it has " + known);
}

void check_settings(const ScreenSettings& settings)
{
    const std::string method = name_of(settings.method);
    require(settings.samples >= 1 && settings.samples <= kMostSamples,
            "the samples of " + method + " must be 1 to " + std::to_string(kMostSamples));
    for (const Row& row : parameter_rows())
        require(
            !knows(settings.method, row) || std::visit(InRange{settings}, row.field),
            std::string(row.shown.name) + " of " + method + " must be " + std::string(row.range));
    if (!has_directions(settings.method)) {
        require(settings.samples % 2 == 0, "the samples of " + method + " must be even");
        return;
    }
    require(settings.samples % settings.directions == 0,
            "the samples of " + method + " must be a multiple of its " +
                std::to_string(settings.directions) + " directions");
    require(settings.method == hbao || settings.directions % 2 == 0,
            "the directions of " + method + " must be even: two a slice");
}

}  // namespace surfelao
