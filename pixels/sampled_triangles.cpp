#include "pixels/sampled_triangles.h"

#include "surfels/buckets.h"
#include "surfels/clones.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace surfelao {
namespace {

/// Rows of one task.
constexpr int kStripRows = 16;

/// Triangles of one task.
constexpr std::size_t kTrianglesOfTask = 8192;

using Samples = std::array<float, kSamplesAtOnce>;

/// Linear in the picture: its value at the middle of pixel (0, 0), and how much it grows a pixel.
struct Plane {
    double value = 0.0;
    glm::dvec2 slope{0.0};

    [[nodiscard]] float at(int x, int y) const
    {
        return static_cast<float>(value + slope.x * x + slope.y * y);
    }
};

/// A triangle as it is seen.
struct Seen {
    std::array<Plane, 3> sides;  ///< >= 0 within
    Plane depth;
    float nearest = std::numeric_limits<float>::infinity();  ///< depths of its corners
    float farthest = -std::numeric_limits<float>::infinity();
};

/// normal . (q, 1), q on the picture plane.
Plane plane_of(const glm::dvec3& normal, const Lens& lens, glm::ivec2 size)
{
    const glm::dvec2 low(lens.low), pixel = glm::dvec2(lens.high - lens.low) / glm::dvec2(size);
    const glm::dvec2 slope = glm::dvec2(normal) * pixel;
    return {normal.x * low.x + normal.y * low.y + normal.z + 0.5 * (slope.x + slope.y), slope};
}

/// How many of rising numbers are below another one: a bit for each number that there may be.
class Ranks {
public:
    Ranks(std::span<const std::uint32_t> numbers, std::size_t limit) : words_(limit / 64 + 1)
    {
        for (const std::uint32_t number : numbers)
            words_[number / 64].bits |= std::uint64_t{1} << number % 64;
        std::uint32_t before = 0;
        for (Word& word : words_) {
            word.before = before;
            before += static_cast<std::uint32_t>(std::popcount(word.bits));
        }
    }
    /// number <= limit
    [[nodiscard]] std::uint32_t below(std::size_t number) const
    {
        const Word& word = words_[number / 64];
        const std::uint64_t lower = (std::uint64_t{1} << number % 64) - 1;
        return word.before + static_cast<std::uint32_t>(std::popcount(word.bits & lower));
    }

private:
    struct Word {
        std::uint64_t bits = 0;
        std::uint32_t before = 0;
    };
    std::vector<Word> words_;
};

class Sampler {
public:
    Sampler(const Projected& projected, std::span<const std::uint32_t> pixels,
            std::span<const glm::vec2> shifts)
        : projected_(projected),
          size_(projected.size()),
          pixels_(pixels),
          shifts_(shifts),
          ranks_(pixels, static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y))
    {
        SURFELAO_CHECK(!shifts.empty() && shifts.size() <= kSamplesAtOnce);
        least_ = projected.view().lens.orthographic ? projected.depth_of(kBeforeEye)
                                                    : -std::numeric_limits<float>::infinity();
        for (std::size_t s = 0; s < shifts.size(); ++s) {
            right_[s] = shifts[s].x;
            up_[s] = shifts[s].y;
        }
    }

    std::vector<std::vector<std::uint32_t>> sample()
    {
        const std::size_t count = projected_.geometry().triangles.size();
        Chunks chunks((count + kTrianglesOfTask - 1) / kTrianglesOfTask);
        for_tasks(chunks.size(), [&](std::size_t chunk) {
            chunks[chunk].emplace(triangles_of_strips(
                chunk * kTrianglesOfTask, std::min(count, (chunk + 1) * kTrianglesOfTask)));
        });
        std::vector<std::vector<std::uint32_t>> triangles(
            shifts_.size(), std::vector<std::uint32_t>(pixels_.size()));
        for_tasks(strip_count(),
                  [&](std::size_t strip) { sample_strip(strip, chunks, triangles); });
        return triangles;
    }

private:
    /// Of kTrianglesOfTask triangles each, those of every strip.
    using Chunks = std::vector<std::optional<Buckets<std::uint32_t>>>;

    /// Of pixels_, those of a row from column first to last.
    struct Run {
        std::uint32_t begin, end;
    };
    [[nodiscard]] Run run_of(int y, int first, int last) const
    {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x);
        return {ranks_.below(row + static_cast<std::size_t>(first)),
                ranks_.below(row + static_cast<std::size_t>(last) + 1)};
    }

    /// A chunk's, by strip.
    [[nodiscard]] Buckets<std::uint32_t> triangles_of_strips(std::size_t begin,
                                                             std::size_t end) const
    {
        struct Rows {
            int first = 1, last = 0;
        };
        const auto& triangles = projected_.geometry().triangles;
        std::vector<Rows> rows(end - begin);
        for (std::size_t t = begin; t < end; ++t) {
            const PixelBox box = projected_.box_of(triangles[t]);
            if (box.is_empty())
                continue;
            const auto is_asked = [&](int y) {
                const Run run = run_of(y, box.first.x, box.last.x);
                return run.begin != run.end;
            };
            Rows& own = rows[t - begin] = {box.first.y, box.last.y};
            while (own.first <= own.last && !is_asked(own.first))
                ++own.first;
            while (own.last > own.first && !is_asked(own.last))
                --own.last;
        }
        return {strip_count(), [&](const auto& put) {
                    for (std::size_t i = 0; i < rows.size(); ++i) {
                        if (rows[i].first > rows[i].last)
                            continue;
                        for (int strip = rows[i].first / kStripRows;
                             strip <= rows[i].last / kStripRows; ++strip)
                            put(static_cast<std::uint32_t>(strip),
                                static_cast<std::uint32_t>(begin + i));
                    }
                }};
    }

    [[nodiscard]] std::size_t strip_count() const
    {
        return static_cast<std::size_t>((size_.y + kStripRows - 1) / kStripRows);
    }

    /// None where it is seen edge-on.
    [[nodiscard]] std::optional<Seen> seen(const glm::uvec3& triangle) const
    {
        const Lens& lens = projected_.view().lens;
        std::array<glm::dvec3, 3> corners;
        std::array<double, 3> forward;
        Seen seen;
        for (int i = 0; i < 3; ++i) {
            const glm::vec3& place = projected_.place(triangle[i]);
            corners[i] = place;
            forward[i] = corners[i].z;
            if (lens.orthographic)
                corners[i].z = 1.0;
            const bool is_before = Projected::is_before_eye(place);
            const float depth = projected_.depth_of(is_before ? kBeforeEye : place.z);
            seen.nearest = std::min(seen.nearest, depth);
            seen.farthest = std::max(seen.farthest, depth);
        }
        std::array<glm::dvec3, 3> normals;
        for (int i = 0; i < 3; ++i)
            normals[i] = glm::cross(corners[(i + 1) % 3], corners[(i + 2) % 3]);
        const double volume = glm::dot(corners[0], normals[0]);
        if (volume == 0.0)
            return {};
        glm::dvec3 depth(0.0);
        for (int i = 0; i < 3; ++i) {
            if (volume < 0.0)
                normals[i] = -normals[i];
            seen.sides[i] = plane_of(normals[i], lens, size_);
            depth += normals[i] * (lens.orthographic ? forward[i] : -1.0);
        }
        seen.depth = plane_of(depth / std::abs(volume), lens, size_);
        return seen;
    }

    SURFELAO_CLONES void sample_strip(std::size_t strip, const Chunks& chunks,
                                      std::vector<std::vector<std::uint32_t>>& triangles) const
    {
        const int first_row = static_cast<int>(strip) * kStripRows,
                  end_row = std::min(first_row + kStripRows, size_.y);
        const std::uint32_t begin = run_of(first_row, 0, 0).begin,
                            end = run_of(end_row - 1, 0, size_.x - 1).end;
        Samples unseen;
        unseen.fill(std::numeric_limits<float>::infinity());
        std::vector<Samples> depths(end - begin, unseen);
        std::vector<std::array<std::uint32_t, kSamplesAtOnce>> nearest(end - begin);
        for (const auto& chunk : chunks) {
            for (const std::uint32_t t : (*chunk)[strip]) {
                const glm::uvec3& triangle = projected_.geometry().triangles[t];
                const PixelBox box = projected_.box_of(triangle);
                const std::optional<Seen> planes = seen(triangle);
                if (!planes)
                    continue;
                for (int y = std::max(box.first.y, first_row);
                     y <= std::min(box.last.y, end_row - 1); ++y) {
                    const Run run = run_of(y, box.first.x, box.last.x);
                    for (std::uint32_t i = run.begin; i < run.end; ++i)
                        cover(*planes, static_cast<int>(pixels_[i]) % size_.x, y, t + 1,
                              depths[i - begin], nearest[i - begin]);
                }
            }
        }
        for (std::size_t s = 0; s < triangles.size(); ++s) {
            for (std::uint32_t i = begin; i < end; ++i)
                triangles[s][i] = nearest[i - begin][s];
        }
    }

    void cover(const Seen& planes, int x, int y, std::uint32_t number, Samples& depths,
               std::array<std::uint32_t, kSamplesAtOnce>& nearest) const
    {
        std::array<float, 3> value;
        for (int i = 0; i < 3; ++i) {
            const Plane& side = planes.sides[i];
            value[i] = side.at(x, y);
            if (value[i] < -0.5001 * (std::abs(side.slope.x) + std::abs(side.slope.y)))
                return;
        }
        const glm::vec2 a(planes.sides[0].slope), b(planes.sides[1].slope),
            c(planes.sides[2].slope), d(planes.depth.slope);
        const float depth = planes.depth.at(x, y);
        for (std::size_t s = 0; s < kSamplesAtOnce; ++s) {
            const float within = std::min(std::min(value[0] + (a.x * right_[s] + a.y * up_[s]),
                                                   value[1] + (b.x * right_[s] + b.y * up_[s])),
                                          value[2] + (c.x * right_[s] + c.y * up_[s]));
            const float linear = depth + (d.x * right_[s] + d.y * up_[s]);
            // exact where the triangle is seen edge-on and the plane is steep
            const float own = std::clamp(linear, planes.nearest, planes.farthest);
            const bool is_nearest = within >= 0.0f && linear >= least_ && own < depths[s];
            depths[s] = is_nearest ? own : depths[s];
            nearest[s] = is_nearest ? number : nearest[s];
        }
    }

    const Projected& projected_;
    glm::ivec2 size_;
    std::span<const std::uint32_t> pixels_;
    std::span<const glm::vec2> shifts_;
    Ranks ranks_;  // of the pixels
    Samples right_{}, up_{};
    /// Without perspective what lies behind the eye is in line with the picture too.
    float least_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> sampled_triangles(const Projected& projected,
                                                          std::span<const std::uint32_t> pixels,
                                                          std::span<const glm::vec2> shifts)
{
    return Sampler(projected, pixels, shifts).sample();
}

// The picture in blocks: a middle of a pixel is a sample of its block.
std::vector<std::uint32_t> middle_triangles(const Projected& projected)
{
    constexpr int kSide = 4;
    static_assert(kSide * kSide == kSamplesAtOnce);
    const glm::ivec2 size = projected.size(), blocks = (size + kSide - 1) / kSide;
    View view = projected.view();
    view.lens = part_of(view.lens, size.x, size.y, {0, 0, kSide * blocks.x, kSide * blocks.y});
    std::array<glm::vec2, kSamplesAtOnce> middles;
    for (int i = 0; i < kSide * kSide; ++i)
        middles[static_cast<std::size_t>(i)] =
            (glm::vec2(i % kSide, i / kSide) + 0.5f) / static_cast<float>(kSide) - 0.5f;
    std::vector<std::uint32_t> all(static_cast<std::size_t>(blocks.x) *
                                   static_cast<std::size_t>(blocks.y));
    std::iota(all.begin(), all.end(), 0u);
    const auto of_blocks =
        sampled_triangles(Projected(projected.geometry(), view, blocks.x, blocks.y), all, middles);

    std::vector<std::uint32_t> triangles(static_cast<std::size_t>(size.x) *
                                         static_cast<std::size_t>(size.y));
    const auto rows = static_cast<std::size_t>(size.y), columns = static_cast<std::size_t>(size.x);
    for_all(rows, 8, [&](std::size_t y) {
        for (std::size_t x = 0; x < columns; ++x)
            triangles[y * columns + x] =
                of_blocks[y % kSide * kSide + x % kSide]
                         [y / kSide * static_cast<std::size_t>(blocks.x) + x / kSide];
    });
    return triangles;
}

}  // namespace surfelao
