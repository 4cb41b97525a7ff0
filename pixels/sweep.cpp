#include "pixels/pixel_compare.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <charconv>
#include <cmath>

namespace surfelao {
namespace {

std::optional<double> finite_number(std::string_view text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return {};
    return value;
}

/// Steps that fit, a millionth of one more than lies there.
double steps_of(const Sweep& sweep)
{
    return std::floor((sweep.to - sweep.from) / sweep.step + 1e-6);
}

}  // namespace

Sweep parse_sweep(std::string_view text)
{
    const std::string all(text);
    const auto cut = [&](char separator) {
        const std::size_t end = std::min(text.find(separator), text.size());
        const std::string_view part = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        return part;
    };
    const auto method = screen_method_of(cut('.'));
    const std::string_view name = cut('=');
    const auto from = finite_number(cut(':')), to = finite_number(cut(':')),
               step = finite_number(text);
    require(method && !name.empty() && from && to && step,
            "\"" + all + "\" is not METHOD.NAME=FROM:TO:STEP, as hbao.bias=0:40:5");
    const Sweep sweep{*method, std::string(name), *from, *to, *step};
    require(sweep.from <= sweep.to && sweep.step > 0.0,
            "\"" + all + "\": FROM must not be beyond TO, and STEP above 0");
    require(steps_of(sweep) < kMostSweep,
            "\"" + all + "\" has more than " + std::to_string(kMostSweep) + " values");
    return sweep;
}

std::vector<double> values_of(const Sweep& sweep)
{
    std::vector<double> values;
    for (int i = 0; i <= static_cast<int>(steps_of(sweep)); ++i)
        values.push_back(sweep.from + i * sweep.step);
    return values;
}

std::vector<PixelEngine> engines_of(const Sweep& sweep, const ScreenSettings& settings)
{
    std::vector<PixelEngine> engines;
    for (const double value : values_of(sweep)) {
        ScreenSettings tried = settings;
        set_parameter(tried, sweep.name, significant(value, 6));
        check_settings(tried);
        engines.emplace_back(tried);
    }
    return engines;
}

}  // namespace surfelao
