#include "viewer/environment.h"

#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace surfelao {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kKey = 0.55f;  // automatic exposure: what an average upward normal receives

/// Averages boxes of source pixels; every source pixel counts with its share of the box.
Image box_shrink(const Image& source, int width, int height)
{
    Image result(width, height);
    for (int y = 0; y < height; ++y) {
        const int top = static_cast<int>(std::int64_t{y} * source.height / height);
        const int bottom =
            std::max(top + 1, static_cast<int>(std::int64_t{y + 1} * source.height / height));
        for (int x = 0; x < width; ++x) {
            const int left = static_cast<int>(std::int64_t{x} * source.width / width);
            const int right =
                std::max(left + 1, static_cast<int>(std::int64_t{x + 1} * source.width / width));
            glm::dvec4 sum(0.0);
            for (int row = top; row < bottom; ++row)
                for (int column = left; column < right; ++column)
                    sum += glm::dvec4(source.at(column, row));
            result.at(x, y) = glm::vec4(
                sum / (static_cast<double>(bottom - top) * static_cast<double>(right - left)));
        }
    }
    return result;
}

glm::vec2 pixel_uv(const Image& image, int x, int y)
{
    return {(static_cast<float>(x) + 0.5f) / static_cast<float>(image.width),
            (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height)};
}

}  // namespace

glm::vec2 panorama_uv(glm::vec3 direction)
{
    const float u = 0.5f + std::atan2(direction.z, direction.x) / (2.0f * kPi);
    return {u, std::acos(glm::clamp(direction.y, -1.0f, 1.0f)) / kPi};
}

glm::vec3 panorama_direction(glm::vec2 uv)
{
    const float turn = (uv.x - 0.5f) * 2.0f * kPi;
    const float polar = uv.y * kPi;
    return {std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)};
}

Image builtin_sky()
{
    // all colours and falloffs by taste
    const glm::vec3 zenith(0.10f, 0.22f, 0.55f), horizon(0.62f, 0.68f, 0.76f);
    const glm::vec3 ground_near(0.11f, 0.10f, 0.09f), ground_far(0.24f, 0.22f, 0.20f);
    const glm::vec3 sun = glm::normalize(glm::vec3(-0.75f, 0.55f, 0.45f));
    const glm::vec3 sun_color(1.00f, 0.74f, 0.46f);

    Image sky(256, 128);
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            const glm::vec3 d = panorama_direction(pixel_uv(sky, x, y));
            const float above = std::max(0.0f, glm::dot(d, sun));
            const glm::vec3 glow =
                sun_color * (1.6f * std::pow(above, 4.0f) + 12.0f * std::pow(above, 64.0f));
            const glm::vec3 air = glm::mix(horizon, zenith, std::pow(std::max(0.0f, d.y), 0.45f));
            const glm::vec3 earth =
                glm::mix(ground_far, ground_near, std::pow(std::max(0.0f, -d.y), 0.5f));
            const float blend = glm::smoothstep(-0.02f, 0.02f, d.y);
            sky.at(x, y) = glm::vec4(glm::mix(earth, air + glow, blend), 1.0f);
        }
    }
    return sky;
}

Image shrink_panorama(const Image& panorama, int max_width)
{
    SURFELAO_CHECK(!panorama.pixels.empty() && max_width >= 1);
    if (panorama.width <= max_width)
        return panorama;
    const std::int64_t height = std::int64_t{panorama.height} * max_width / panorama.width;
    return box_shrink(panorama, max_width, static_cast<int>(std::max<std::int64_t>(1, height)));
}

Image irradiance_map(const Image& panorama)
{
    SURFELAO_CHECK(!panorama.pixels.empty());
    const Image small =
        box_shrink(panorama, std::min(panorama.width, 128), std::min(panorama.height, 64));
    // every pixel as a light: where it is, and its radiance times its solid angle over pi
    struct Light {
        glm::vec3 direction, radiance;
    };
    std::vector<Light> lights;
    for (int y = 0; y < small.height; ++y) {
        // the exact solid angle of a row, so that a uniform sky gives its own value back
        const float top = static_cast<float>(y) / static_cast<float>(small.height);
        const float bottom = static_cast<float>(y + 1) / static_cast<float>(small.height);
        const float solid_angle = 2.0f * kPi / static_cast<float>(small.width) *
                                  (std::cos(top * kPi) - std::cos(bottom * kPi));
        for (int x = 0; x < small.width; ++x)
            lights.push_back({panorama_direction(pixel_uv(small, x, y)),
                              glm::vec3(small.at(x, y)) * (solid_angle / kPi)});
    }

    Image result(64, 32);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const glm::vec3 normal = panorama_direction(pixel_uv(result, x, y));
            glm::vec3 sum(0.0f);
            for (const Light& light : lights)
                sum += std::max(0.0f, glm::dot(normal, light.direction)) * light.radiance;
            result.at(x, y) = glm::vec4(sum, 1.0f);
        }
    }
    return result;
}

std::vector<Image> halved_panoramas(const Image& panorama)
{
    std::vector<Image> halves = {panorama};
    while (halves.back().height > 1) {
        const Image& last = halves.back();
        halves.push_back(box_shrink(last, std::max(1, last.width / 2), last.height / 2));
    }
    return halves;
}

glm::vec3 patch_light(std::span<const Image> halves, glm::vec3 direction, float alpha)
{
    const float texels =
        alpha * static_cast<float>(halves[0].width) * static_cast<float>(halves[0].height);
    const float last = static_cast<float>(halves.size() - 1);
    const float level = glm::clamp(0.5f * std::log2(std::max(texels, 1.0f)), 0.0f, last);
    const auto finer = static_cast<std::size_t>(level);
    const std::size_t coarser = std::min(finer + 1, halves.size() - 1);
    const glm::vec2 uv = panorama_uv(direction);
    return glm::mix(glm::vec3(sample_panorama(halves[finer], uv)),
                    glm::vec3(sample_panorama(halves[coarser], uv)),
                    level - static_cast<float>(finer));
}

float automatic_exposure(const Image& irradiance)
{
    double sum = 0.0;
    for (int y = 0; y < irradiance.height / 2; ++y)
        for (int x = 0; x < irradiance.width; ++x)
            sum += glm::dot(glm::vec3(irradiance.at(x, y)), glm::vec3(0.2126f, 0.7152f, 0.0722f));
    const double mean = sum / (0.5 * irradiance.width * irradiance.height);
    return mean > 0.0 ? static_cast<float>(kKey / mean) : 1.0f;
}

glm::mat3 sky_frame(glm::vec3 up)
{
    // up z: x stays, z becomes y, y becomes -z
    return up.z > 0.5f ? glm::mat3(glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(0, 1, 0))
                       : glm::mat3(1.0f);
}

glm::vec3 soften(glm::vec3 light)
{
    const glm::vec3 over = glm::max(light - 0.6f, 0.0f);
    return glm::min(light, glm::vec3(0.6f)) + 0.4f * (1.0f - glm::exp(-over / 0.4f));
}

}  // namespace surfelao
