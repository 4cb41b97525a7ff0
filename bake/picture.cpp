#include "bake/picture.h"

#include "surfels/errors.h"

#include <zlib.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace surfelao {
namespace {

constexpr int kSupersampling = 2;  // a side
constexpr float kMargin = 0.96f;   // of the picture that the scene may fill

/// Where a mesh is looked at from: towards the viewer, and what is right and up for them.
struct View {
    glm::vec3 towards = glm::normalize(glm::vec3(0.55f, 0.45f, 0.75f));
    glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), towards));
    glm::vec3 up = glm::cross(towards, right);
};

struct Sample {
    float depth = -std::numeric_limits<float>::infinity();  ///< larger = nearer
    Rgb color{255, 255, 255};
};

/// Puts faces that look away behind all that look at the viewer (depths lie within +-1).
constexpr float kBehindAll = 4.0f;

void draw_triangle(const glm::vec3 (&corner)[3], const Rgb* const (&color)[3], float shade,
                   float depth_offset, int width, int height, std::vector<Sample>& samples)
{
    const auto cross2 = [](glm::vec3 a, glm::vec3 b, glm::vec3 p) {
        return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    };
    const float doubled = cross2(corner[0], corner[1], corner[2]);
    if (doubled == 0.0f)
        return;
    const auto low = [](float x) { return static_cast<int>(std::floor(x)); };
    const glm::vec3 least = glm::min(corner[0], glm::min(corner[1], corner[2]));
    const glm::vec3 most = glm::max(corner[0], glm::max(corner[1], corner[2]));
    for (int y = std::max(0, low(least.y)); y <= std::min(height - 1, low(most.y)); ++y) {
        for (int x = std::max(0, low(least.x)); x <= std::min(width - 1, low(most.x)); ++x) {
            const glm::vec3 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.0f);
            const float a = cross2(corner[1], corner[2], p) / doubled;
            const float b = cross2(corner[2], corner[0], p) / doubled;
            const float c = 1.0f - a - b;
            if (a < 0.0f || b < 0.0f || c < 0.0f)
                continue;
            const float depth = a * corner[0].z + b * corner[1].z + c * corner[2].z + depth_offset;
            Sample& sample = samples[static_cast<std::size_t>(y * width + x)];
            if (depth <= sample.depth)
                continue;
            sample.depth = depth;
            for (std::size_t i = 0; i < 3; ++i) {
                const float value = a * static_cast<float>((*color[0])[i]) +
                                    b * static_cast<float>((*color[1])[i]) +
                                    c * static_cast<float>((*color[2])[i]);
                sample.color[i] =
                    static_cast<std::uint8_t>(std::clamp(shade * value + 0.5f, 0.0f, 255.0f));
            }
        }
    }
}

void put_big_endian(std::string& bytes, std::uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes += static_cast<char>(value >> shift & 0xFF);
}

/// Length, type, data, checksum of type and data (PNG specification, 5.3).
void put_chunk(std::string& png, const std::string& type, const std::string& data)
{
    put_big_endian(png, static_cast<std::uint32_t>(data.size()));
    const std::string body = type + data;
    png += body;
    put_big_endian(png,
                   static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                                                    static_cast<uInt>(body.size()))));
}

}  // namespace

Picture draw_vertices(const Geometry& geometry, std::span<const Rgb> colors, int width, int height)
{
    SURFELAO_CHECK(colors.size() == geometry.positions.size());
    const View view;
    const int fine_width = width * kSupersampling, fine_height = height * kSupersampling;

    // into view coordinates, and their box
    std::vector<glm::vec3> places(geometry.positions.size());
    glm::vec3 least(std::numeric_limits<float>::max()), most(std::numeric_limits<float>::lowest());
    for (const glm::uvec3 triangle : geometry.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 p = geometry.positions[triangle[corner]];
            glm::vec3& place = places[triangle[corner]];
            place = {glm::dot(p, view.right), -glm::dot(p, view.up), glm::dot(p, view.towards)};
            least = glm::min(least, place);
            most = glm::max(most, place);
        }
    }
    const glm::vec3 size = glm::max(most - least, glm::vec3(1e-6f));
    const float scale = kMargin * std::min(static_cast<float>(fine_width) / size.x,
                                           static_cast<float>(fine_height) / size.y);
    const glm::vec3 middle = 0.5f * (least + most);
    for (glm::vec3& place : places) {
        place.x = 0.5f * static_cast<float>(fine_width) + scale * (place.x - middle.x);
        place.y = 0.5f * static_cast<float>(fine_height) + scale * (place.y - middle.y);
    }

    std::vector<Sample> samples(static_cast<std::size_t>(fine_width * fine_height));
    for (const glm::uvec3 triangle : geometry.triangles) {
        const glm::vec3 a = geometry.positions[triangle.x], b = geometry.positions[triangle.y],
                        c = geometry.positions[triangle.z];
        const float facing = glm::dot(glm::normalize(glm::cross(b - a, c - a)), view.towards);
        const glm::vec3 corners[3] = {places[triangle.x], places[triangle.y], places[triangle.z]};
        const Rgb* const corner_colors[3] = {&colors[triangle.x], &colors[triangle.y],
                                             &colors[triangle.z]};
        draw_triangle(corners, corner_colors, 0.6f + 0.4f * std::fabs(facing),
                      facing > 0.0f ? 0.0f : -kBehindAll, fine_width, fine_height, samples);
    }

    Picture picture{width, height, std::vector<Rgb>(static_cast<std::size_t>(width * height))};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (std::size_t i = 0; i < 3; ++i) {
                int sum = 0;
                for (int part = 0; part < kSupersampling * kSupersampling; ++part) {
                    const int fine_x = x * kSupersampling + part % kSupersampling;
                    const int fine_y = y * kSupersampling + part / kSupersampling;
                    sum += samples[static_cast<std::size_t>(fine_y * fine_width + fine_x)].color[i];
                }
                picture.pixels[static_cast<std::size_t>(y * width + x)][i] =
                    static_cast<std::uint8_t>(sum / (kSupersampling * kSupersampling));
            }
        }
    }
    return picture;
}

std::string png_of(const Picture& picture)
{
    std::string rows;
    for (int y = 0; y < picture.height; ++y) {
        rows += '\0';  // no filter
        const Rgb* row = picture.pixels.data() + static_cast<std::ptrdiff_t>(y) * picture.width;
        rows.append(reinterpret_cast<const char*>(row),
                    static_cast<std::size_t>(picture.width) * 3);
    }
    uLongf size = compressBound(static_cast<uLong>(rows.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(rows.data()), static_cast<uLong>(rows.size()),
                  Z_BEST_COMPRESSION) != Z_OK)
        throw std::runtime_error("a picture cannot be compressed");
    packed.resize(size);

    std::string png = "\x89PNG\r\n\x1a\n";
    std::string header;
    put_big_endian(header, static_cast<std::uint32_t>(picture.width));
    put_big_endian(header, static_cast<std::uint32_t>(picture.height));
    header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, RGB, no interlace
    put_chunk(png, "IHDR", header);
    put_chunk(png, "IDAT", packed);
    put_chunk(png, "IEND", "");
    return png;
}

}  // namespace surfelao
