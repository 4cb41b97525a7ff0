#include "screen_twin.h"

#include "gpu/screen_samples.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>

namespace surfelao {
namespace {

using glm::dvec2;
using glm::dvec3;
constexpr double kPi = std::numbers::pi;

double fraction_of(double x)
{
    return x - std::floor(x);
}

/// Interleaved gradient noise in whole numbers: shaders/screen_noise.glsl.
double gradient_noise(std::uint32_t x, std::uint32_t y)
{
    const std::uint32_t inner = x * 288237660u + y * 25070368u;
    return ((inner * 53u - (inner >> 16) * 1119u) >> 8) / 16777216.0;
}

/// One pixel of a picture, and what it sees of others.
struct Asked {
    const ReadPicture& picture;
    const ScreenSettings& settings;
    const Definition& definition;
    int x, y;
    double radius;  // R
    const std::vector<glm::vec4>& samples;
    const std::vector<glm::vec2>& probes;

    bool is_inside(glm::ivec2 p) const
    {
        return p.x >= 0 && p.y >= 0 && p.x < picture.width && p.y < picture.height;
    }
    const glm::vec4& texel(glm::ivec2 p) const
    {
        return picture.surface[static_cast<std::size_t>(p.y * picture.width + p.x)];
    }
    bool is_background(glm::ivec2 p) const { return texel(p).w >= kNothingThere; }
    dvec2 pixels_per_unit(double z) const
    {
        const dvec2 scale = dvec2(picture.width, picture.height) /
                            dvec2(picture.view.lens.high - picture.view.lens.low);
        return picture.view.lens.orthographic ? scale : scale / z;
    }
    dvec3 position_of(glm::ivec2 p) const
    {
        const Lens& lens = picture.view.lens;
        const dvec2 q = dvec2(lens.low) + dvec2(lens.high - lens.low) * (dvec2(p) + 0.5) /
                                              dvec2(picture.width, picture.height);
        const double z = static_cast<double>(texel(p).w);
        return lens.orthographic ? dvec3(q, z) : dvec3(z * q, z);
    }
    glm::ivec2 here() const { return {x, y}; }
    dvec3 position() const { return position_of(here()); }
    dvec3 normal() const { return dvec3(texel(here())); }
    dvec3 to_eye() const
    {
        return picture.view.lens.orthographic ? dvec3(0, 0, -1) : -glm::normalize(position());
    }
    glm::ivec2 beside(dvec2 offset) const
    {
        return {std::floor(x + 0.5 + offset.x), std::floor(y + 0.5 + offset.y)};
    }
    dvec2 noise() const;
};

dvec2 Asked::noise() const
{
    static const std::vector<glm::vec2> table = noise_pairs();
    const bool is_ssao =
        settings.method == ScreenMethod::ssao_disc || settings.method == ScreenMethod::ssao_sphere;
    const int side = settings.noise == ScreenNoise::none ? 1 : is_ssao ? 4 : kNoiseSide;
    dvec2 pair(table[static_cast<std::size_t>(y % side * kNoiseSide + x % side)]);
    const auto u = static_cast<std::uint32_t>(x), v = static_cast<std::uint32_t>(y);
    if (settings.noise == ScreenNoise::gradient)
        pair = {gradient_noise(u, v), gradient_noise(u + 37, v + 11)};
    return {fraction_of(pair.x + settings.frame * 0.7548776662466927),
            fraction_of(pair.y + settings.frame * 0.5698402910980532)};
}

// ---- ssao

double ssao(const Asked& asked)
{
    const bool is_disc = asked.settings.method == ScreenMethod::ssao_disc;
    const dvec3 p = asked.position();
    const bool orthographic = asked.picture.view.lens.orthographic;
    double radius = asked.radius;
    if (is_disc && !orthographic)
        radius *= p.z / std::max(0.5, static_cast<double>(glm::length(asked.picture.view.eye)));
    const dvec2 scale = asked.pixels_per_unit(p.z);
    if (radius * scale.y < 1.0)
        return 0.0;
    const dvec2 noise = asked.noise();
    const double height = 2.0 * noise.x - 1.0, angle = 2.0 * kPi * noise.y;
    const double across = std::sqrt(1.0 - height * height);
    const dvec3 axis(across * std::cos(angle), across * std::sin(angle), height);
    const dvec3 mirror = glm::normalize(axis - dvec3(0, 0, 1));
    std::vector<std::optional<double>> values;
    for (const glm::vec4& sample : asked.samples) {
        const dvec3 offset =
            radius * (dvec3(sample) - 2.0 * glm::dot(dvec3(sample), mirror) * mirror);
        const dvec3 q = p + offset;
        // where it is seen, in pixels from p
        dvec2 seen_at = dvec2(offset) * scale;
        if (!is_disc && !orthographic)
            seen_at = dvec2(q) * asked.pixels_per_unit(q.z) - dvec2(p) * scale;
        values.emplace_back();
        const glm::ivec2 place = asked.beside(seen_at);
        if ((q.z <= 0.0 && !orthographic) || !asked.is_inside(place))
            continue;
        const double z = static_cast<double>(asked.texel(place).w);
        const double reach = static_cast<double>(asked.settings.reach);
        double validity = p.z - z <= reach * radius ? 1.0 : 0.0;
        if (asked.settings.ratio_test)
            validity = 1.0 - std::clamp((p.z - z) / z, 0.0, 1.0);
        values.back() = 0.5 + validity * ((z > q.z ? 1.0 : 0.0) - 0.5);
    }
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!values[i] || (asked.settings.pairs && !values[i ^ 1]))
            continue;
        sum += *values[i];
        count += 1.0;
    }
    return count > 0.0 ? 1.0 - std::min(1.0, 2.0 * sum / count) : 0.0;
}

// ---- vo

double chosen_radius(const Asked& asked)
{
    const int rule = asked.settings.rule;
    if (rule == 0)
        return asked.radius;
    const dvec3 p = asked.position();
    const double limit = static_cast<double>(asked.settings.depth_limit) * asked.radius;
    std::vector<dvec3> probes;
    for (const glm::vec2 offset : asked.probes) {
        const glm::ivec2 place =
            asked.beside(dvec2(offset) * asked.radius * asked.pixels_per_unit(p.z));
        if (asked.is_inside(place) && !asked.is_background(place))
            probes.push_back(asked.position_of(place));
    }
    double nearest = p.z, nearer_sum = 0.0, squares = 0.0;
    int nearer_count = 0;
    for (const dvec3& probe : probes) {
        nearest = std::min(nearest, probe.z);
        squares += (probe.z - p.z) * (probe.z - p.z);
        nearer_sum += probe.z < p.z ? probe.z : 0.0;
        nearer_count += probe.z < p.z ? 1 : 0;
    }
    const auto rise = [&](double z) { return asked.radius * std::clamp((p.z - z) / z, 0.0, 1.0); };
    double summit_z = p.z, summit_distance = rule == 6 ? asked.radius : 1e30, found = 0.0;
    switch (rule) {
        case 1:
            return rise(nearest);
        case 2:
            return nearer_count > 0 ? rise(nearer_sum / nearer_count) : 0.0;
        case 3:
            return probes.empty() ? 0.0
                                  : rise(std::sqrt(squares / static_cast<double>(probes.size())));
        case 4:
            return p.z - nearest < limit ? rise(nearest) : asked.radius;
        case 5:
            for (const dvec3& probe : probes) {
                if (probe.z >= summit_z || p.z - probe.z >= limit)
                    continue;
                summit_z = probe.z;
                found = std::min(glm::distance(probe, p), asked.radius);
            }
            return found;
        default:
            for (const dvec3& probe : probes) {
                if (probe.z >= summit_z || glm::distance(probe, p) >= summit_distance)
                    continue;
                summit_z = probe.z;
                found = summit_distance = glm::distance(probe, p);
            }
            return found;
    }
}

/// Twice the free share of the ball of that radius, at most 1.
double free_share(const Asked& asked, double radius)
{
    const std::vector<glm::vec4>& lines = asked.samples;
    const dvec3 p = asked.position();
    const dvec2 scale = radius * asked.pixels_per_unit(p.z);
    if (scale.y < 1.0)
        return 1.0;
    const double angle = kPi * asked.noise().x, c = std::cos(angle), s = std::sin(angle);
    const double reach = static_cast<double>(asked.settings.reach);
    enum class Known { yes, too_near, outside };
    std::vector<double> free;
    std::vector<Known> known;
    for (const glm::vec4& line : lines) {
        const dvec2 at(line.x * c - line.y * s, line.x * s + line.y * c);
        const double half = static_cast<double>(line.z);
        const glm::ivec2 place = asked.beside(at * scale);
        free.push_back(half);
        known.push_back(Known::outside);
        if (!asked.is_inside(place))
            continue;
        const double depth = (static_cast<double>(asked.texel(place).w) - p.z) / radius;
        known.back() = depth < -reach ? Known::too_near : Known::yes;
        if (depth >= -reach)
            free.back() = std::max(std::min(half, depth) + half, 0.0);
    }
    double sum = 0.0, volume = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::size_t other = i ^ 1;
        const double whole = 2.0 * static_cast<double>(lines[i].z);
        double share = free[i] / whole;
        bool counts = known[i] != Known::outside;
        if (asked.settings.pairs) {
            counts = counts || known[other] != Known::outside;
            if (known[i] != Known::yes && known[other] == Known::yes)
                share = 1.0 - free[other] / whole;
        }
        if (!counts)
            continue;
        sum += static_cast<double>(lines[i].w) * share;
        volume += static_cast<double>(lines[i].w);
    }
    return volume > 0.0 ? std::min(1.0, 2.0 * sum / volume) : 1.0;
}

double vo(const Asked& asked)
{
    const double radius = chosen_radius(asked);
    const double wide = free_share(asked, radius);
    if (asked.settings.dual == DualRadii::none)
        return 1.0 - wide;
    const double near = free_share(asked, 0.5 * radius);
    return 1.0 - (asked.settings.dual == DualRadii::product ? wide * near : std::min(wide, near));
}

// ---- hbao, gtao, bitmask

/// What is seen in a slice: angle from V, positive on the asked side; distance.
struct InSlice {
    double angle = 0.0, distance = 0.0;
    double back = 0.0;  // angle of the point a thickness behind it
};

struct TwinSlice {
    const Asked& asked;
    dvec3 eye, across, axis, normal;
    dvec2 direction;

    TwinSlice(const Asked& from, dvec3 n, double angle)
        : asked(from), eye(from.to_eye()), normal(n), direction(std::cos(angle), std::sin(angle))
    {
        const dvec3 along(direction, 0.0);
        across = glm::normalize(along - glm::dot(along, eye) * eye);
        axis = glm::cross(eye, across);
    }
    double gamma() const { return std::atan2(glm::dot(normal, across), glm::dot(normal, eye)); }
    double share() const { return std::hypot(glm::dot(normal, across), glm::dot(normal, eye)); }
    double angle_of(dvec3 d) const
    {
        const double slope = glm::dot(normal, axis) / std::max(glm::dot(normal, eye), 0.05);
        return std::atan2(glm::dot(d, across), glm::dot(d, eye) + slope * glm::dot(d, axis));
    }
    /// At that share of the radius; side: 1 or -1.
    std::optional<InSlice> at(double share, double side) const
    {
        const dvec3 p = asked.position();
        dvec2 offset = share * asked.radius * direction * asked.pixels_per_unit(p.z);
        if (glm::length(offset) < 1.0)
            offset = glm::normalize(direction * asked.pixels_per_unit(p.z));
        const glm::ivec2 place = asked.beside(side * offset);
        if (!asked.is_inside(place) || asked.is_background(place))
            return {};
        const dvec3 q = asked.position_of(place);
        const double thickness =
            std::min(1e6, static_cast<double>(asked.settings.thickness) * asked.radius);
        const double slope = glm::dot(normal, axis) / std::max(glm::dot(normal, eye), 0.05);
        const dvec3 d = q - p;
        const double y = glm::dot(d, eye) + slope * glm::dot(d, axis);
        return InSlice{side * angle_of(d), std::hypot(glm::dot(d, across), y),
                       side * angle_of(d - thickness * eye)};
    }
};

double faded(const Asked& asked, double distance)
{
    const double x = distance / asked.radius, rest = std::max(0.0, 1.0 - x * x);
    if (asked.definition.falloff == Falloff::smooth)
        return rest * rest;
    return rest > 0.0 ? 1.0 : 0.0;
}

/// Integral of cos(a - gamma) |sin a| from 0 to an angle, as the paper has it.
double inner_integral(double angle, double gamma)
{
    return 0.25 *
           (-std::cos(2.0 * angle - gamma) + std::cos(gamma) + 2.0 * angle * std::sin(gamma));
}

/// The angle whose cosine lies by that weight between those of two.
double mixed_angle(double low, double high, double weight)
{
    return std::acos(
        std::clamp(std::cos(low) + weight * (std::cos(high) - std::cos(low)), -1.0, 1.0));
}

/// Hidden and whole integral of one slice.
dvec2 gtao_slice(const TwinSlice& slice, int steps, double jitter, double)
{
    dvec2 sums(0.0);
    for (const double side : {1.0, -1.0}) {
        const double gamma = side * slice.gamma(), low = gamma + kPi / 2;
        double horizon = low;
        for (int k = 0; k < steps; ++k) {
            const auto seen = slice.at(
                std::pow((k + jitter) / steps, static_cast<double>(slice.asked.settings.power)),
                side);
            if (seen)
                horizon = std::min(
                    horizon, mixed_angle(low, seen->angle, faded(slice.asked, seen->distance)));
        }
        const double whole = inner_integral(low, gamma);
        sums += dvec2(whole - inner_integral(horizon, gamma), whole);
    }
    return sums;
}

/// dither: where in a bit ends are rounded.
dvec2 bitmask_slice(const TwinSlice& slice, int steps, double jitter, double dither)
{
    constexpr int kBits = 32;
    const double gamma = slice.gamma();
    const double left = inner_integral(kPi / 2 - gamma, -gamma);
    const double whole = left + inner_integral(kPi / 2 + gamma, gamma);
    std::array<bool, kBits> hidden{};
    for (const double side : {1.0, -1.0}) {
        const double low = side * gamma + kPi / 2;
        for (int k = 0; k < steps; ++k) {
            const auto seen = slice.at(
                std::pow((k + jitter) / steps, static_cast<double>(slice.asked.settings.power)),
                side);
            const double weight = seen ? faded(slice.asked, seen->distance) : 0.0;
            if (weight == 0.0)
                continue;
            const double front = std::min(low, mixed_angle(low, seen->angle, weight));
            const double back = mixed_angle(low, std::min(low, seen->back), weight);
            const double a = left + side * inner_integral(front, side * gamma);
            const double b = left + side * inner_integral(back, side * gamma);
            for (int bit = 0; bit < kBits; ++bit) {
                const double middle = whole * (bit + 1 - dither) / kBits;
                if (middle >= std::min(a, b) && middle < std::max(a, b))
                    hidden[static_cast<std::size_t>(bit)] = true;
            }
        }
    }
    return {whole * static_cast<double>(std::ranges::count(hidden, true)) / kBits, whole};
}

double slices(const Asked& asked)
{
    const int count = asked.settings.directions / 2;
    const int steps = asked.settings.samples / asked.settings.directions;
    const dvec2 noise = asked.noise();
    if (asked.radius * asked.pixels_per_unit(asked.position().z).y < 1.0)
        return 0.0;
    dvec2 sums(0.0);
    for (int k = 0; k < count; ++k) {
        const TwinSlice slice(asked, asked.normal(), (k + noise.x) * kPi / count);
        auto* const of = asked.settings.method == ScreenMethod::gtao ? &gtao_slice : &bitmask_slice;
        sums += slice.share() * of(slice, steps, noise.y,
                                   0.001 + 0.998 * fraction_of(noise.x + k * 0.6180339887498949));
    }
    return sums.y > 0.0 ? std::clamp(sums.x / sums.y, 0.0, 1.0) : 0.0;
}

/// From the four pixels around.
dvec3 depth_normal(const Asked& asked)
{
    std::array<dvec3, 2> tangents{};
    for (int way = 0; way < 2; ++way) {
        double least = 1e30;
        for (const int side : {-1, 1}) {
            const glm::ivec2 place = asked.here() + side * glm::ivec2(1 - way, way);
            if (!asked.is_inside(place) || asked.is_background(place))
                continue;
            const dvec3 d =
                static_cast<double>(side) * (asked.position_of(place) - asked.position());
            if (std::abs(d.z) < least) {
                least = std::abs(d.z);
                tangents[static_cast<std::size_t>(way)] = d;
            }
        }
    }
    const dvec3 face = glm::cross(tangents[0], tangents[1]);
    if (glm::length(face) == 0.0)
        return asked.normal();
    return glm::normalize(glm::dot(face, asked.to_eye()) < 0.0 ? -face : face);
}

double hbao(const Asked& asked)
{
    const int steps = asked.settings.samples / asked.settings.directions;
    const dvec2 noise = asked.noise();
    if (asked.radius * asked.pixels_per_unit(asked.position().z).y < 1.0)
        return 0.0;
    const dvec3 normal = asked.settings.normals ? asked.normal() : depth_normal(asked);
    double sum = 0.0;
    for (int i = 0; i < asked.settings.directions; ++i) {
        const TwinSlice slice(asked, normal, (i + noise.x) * 2.0 * kPi / asked.settings.directions);
        const double tangent =
            -slice.gamma() + static_cast<double>(asked.settings.bias) * kPi / 180.0;
        double best = std::sin(std::min(tangent, kPi / 2));
        for (int k = 0; k < steps; ++k) {
            const auto seen = slice.at((k + noise.y) / steps, 1.0);
            if (!seen)
                continue;
            const double sine = std::cos(seen->angle);
            const double x = seen->distance / asked.radius;
            const bool own = asked.settings.fade && asked.definition.falloff == Falloff::none;
            const double weight = own ? std::max(0.0, 1.0 - x * x) : faded(asked, seen->distance);
            if (weight > 0.0 && sine > best) {
                sum += weight * (sine - best);
                best = sine;
            }
        }
    }
    return std::clamp(sum / asked.settings.directions, 0.0, 1.0);
}

// ---- pictures

std::vector<float> picture_of(const ReadPicture& picture, const ScreenSettings& settings,
                              const Definition& definition,
                              const std::function<double(const Asked&)>& of)
{
    auto* const make = settings.method == ScreenMethod::ssao_disc     ? &disk_samples
                       : settings.method == ScreenMethod::ssao_sphere ? &ball_samples
                                                                      : &line_samples;
    const std::vector<glm::vec4> samples = make(settings.samples, settings.pairs);
    const std::vector<glm::vec2> probes = probe_offsets(settings.probes);
    std::vector<float> values;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const Asked asked{picture, settings, definition,
                              x,       y,        static_cast<double>(definition.max_distance),
                              samples, probes};
            values.push_back(asked.is_background({x, y}) ? 0.0f : static_cast<float>(of(asked)));
        }
    }
    return values;
}

double blurred(const Asked& asked, const std::vector<float>& sharp)
{
    double sum = 0.0, count = 0.0;
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            const glm::ivec2 place = asked.here() + glm::ivec2(dx, dy);
            if (!asked.is_inside(place) || asked.is_background(place))
                continue;
            const dvec3 d = asked.position_of(place) - asked.position();
            if (std::abs(glm::dot(d, asked.normal())) >= 0.1 * asked.radius ||
                glm::dot(dvec3(asked.texel(place)), asked.normal()) <= 0.8)
                continue;
            sum += static_cast<double>(
                sharp[static_cast<std::size_t>(place.y * asked.picture.width + place.x)]);
            count += 1.0;
        }
    }
    return sum / count;
}

}  // namespace

std::vector<float> screen_twin(const ReadPicture& picture, const ScreenSettings& settings,
                               const Definition& definition)
{
    const auto of = [](const Asked& asked) {
        switch (asked.settings.method) {
            case ScreenMethod::ssao_disc:
            case ScreenMethod::ssao_sphere:
                return ssao(asked);
            case ScreenMethod::vo:
                return vo(asked);
            case ScreenMethod::hbao:
                return hbao(asked);
            default:
                return slices(asked);
        }
    };
    const std::vector<float> sharp = picture_of(picture, settings, definition, of);
    if (!settings.blur)
        return sharp;
    return picture_of(picture, settings, definition,
                      [&](const Asked& asked) { return blurred(asked, sharp); });
}

std::vector<float> radius_twin(const ReadPicture& picture, const ScreenSettings& settings,
                               const Definition& definition)
{
    return picture_of(picture, settings, definition,
                      [](const Asked& asked) { return chosen_radius(asked) / asked.radius; });
}

}  // namespace surfelao
