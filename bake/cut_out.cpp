#include "bake/cut_out.h"

#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/srgb.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

namespace surfelao {
namespace {

/// A picture's alpha, and how many of its texels are below the cutoff.
class AlphaMap {
public:
    AlphaMap(const Image& picture, const BaseColor& material)
        : width_(picture.width), height_(picture.height), cutoff_(material.cutoff)
    {
        const bool is_grey =
            material.grey_is_alpha &&
            std::ranges::all_of(picture.pixels, [](const glm::vec4& p) { return p.a >= 1.0f; });
        alpha_.reserve(picture.pixels.size());
        for (const glm::vec4& pixel : picture.pixels)
            alpha_.push_back(material.alpha * (is_grey ? srgb_encode(pixel.r) : pixel.a));
        const auto columns = static_cast<std::size_t>(width_) + 1;
        below_.assign(columns * (static_cast<std::size_t>(height_) + 1), 0);
        for (int y = 0; y < height_; ++y) {
            std::uint32_t row = 0;
            for (int x = 0; x < width_; ++x) {
                row += at(x, y) < cutoff_ ? 1 : 0;
                below_[index(x + 1, y + 1)] = below_[index(x + 1, y)] + row;
            }
        }
    }

    [[nodiscard]] glm::dvec2 size() const { return {width_, height_}; }

    enum class Look { there, gone, mixed };

    /// What any point between these texture coordinates shows; the picture repeats.
    [[nodiscard]] Look look(glm::dvec2 low, glm::dvec2 high) const
    {
        const auto [x, columns] = texels(low.x, high.x, width_);
        const auto [y, rows] = texels(low.y, high.y, height_);
        const std::uint64_t count = count_below(x, columns, y, rows);
        if (count == 0)
            return Look::there;
        return count == std::uint64_t(columns) * std::uint64_t(rows) ? Look::gone : Look::mixed;
    }

    /// Linear between four texels.
    [[nodiscard]] bool is_there(glm::dvec2 uv) const
    {
        const glm::dvec2 place = (uv - glm::floor(uv)) * size() - 0.5;
        const glm::dvec2 base = glm::floor(place), share = place - base;
        const auto texel = [&](int dx, int dy) {
            return double(
                at((int(base.x) + dx + width_) % width_, (int(base.y) + dy + height_) % height_));
        };
        const double above = (1.0 - share.x) * texel(0, 0) + share.x * texel(1, 0);
        const double under = (1.0 - share.x) * texel(0, 1) + share.x * texel(1, 1);
        return (1.0 - share.y) * above + share.y * under >= cutoff_;
    }

private:
    [[nodiscard]] float at(int x, int y) const
    {
        return alpha_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(x)];
    }
    [[nodiscard]] std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * (static_cast<std::size_t>(width_) + 1) +
               static_cast<std::size_t>(x);
    }

    /// First and number of the texels that are looked up between two coordinates along one side.
    static std::pair<int, int> texels(double low, double high, int side)
    {
        const double first = std::floor(low * side - 0.5);
        const double count = std::floor(high * side - 0.5) + 2.0 - first;
        if (!(count < side))
            return {0, side};
        return {static_cast<int>(first - std::floor(first / side) * side), static_cast<int>(count)};
    }

    /// In ranges that may go on at the other side.
    [[nodiscard]] std::uint64_t count_below(int x, int columns, int y, int rows) const
    {
        std::uint64_t count = 0;
        for (const auto& [from_y, to_y] : pieces_of(y, rows, height_)) {
            for (const auto& [from_x, to_x] : pieces_of(x, columns, width_))
                count += below_[index(to_x, to_y)] - below_[index(from_x, to_y)] -
                         below_[index(to_x, from_y)] + below_[index(from_x, from_y)];
        }
        return count;
    }
    static std::array<std::pair<int, int>, 2> pieces_of(int first, int count, int side)
    {
        const int end = std::min(first + count, side);
        return {std::pair(first, end), std::pair(0, first + count - end)};
    }

    int width_, height_;
    float cutoff_;
    std::vector<float> alpha_;
    std::vector<std::uint32_t> below_;  ///< sums of all texels above and left
};

/// A triangle in the space of the world and in that of the picture.
struct CutTriangle {
    const AlphaMap* alpha = nullptr;
    glm::dvec3 places[3]{};
    glm::dvec2 uvs[3]{};
};

struct OpenPiece {
    double area = 0.0;
    std::uint32_t number = 0;  ///< in the order in which they came to be
    CutOut::Piece piece;
    bool operator<(const OpenPiece& other) const
    {
        return std::tie(area, other.number) < std::tie(other.area, number);
    }
};

template <class Value>
Value at(const Value (&corners)[3], glm::dvec2 weights)
{
    return (1.0 - weights.x - weights.y) * corners[0] + weights.x * corners[1] +
           weights.y * corners[2];
}

double area_of(const CutTriangle& triangle, const CutOut::Piece& piece)
{
    const glm::dvec3 a = at(triangle.places, piece.corners[0]);
    return 0.5 * glm::length(glm::cross(at(triangle.places, piece.corners[1]) - a,
                                        at(triangle.places, piece.corners[2]) - a));
}

AlphaMap::Look look_at(const CutTriangle& triangle, const CutOut::Piece& piece)
{
    glm::dvec2 low = at(triangle.uvs, piece.corners[0]), high = low;
    for (int k = 1; k < 3; ++k) {
        low = glm::min(low, at(triangle.uvs, piece.corners[k]));
        high = glm::max(high, at(triangle.uvs, piece.corners[k]));
    }
    return triangle.alpha->look(low, high);
}

/// Whether no side is longer than a texel.
bool is_one_texel(const CutTriangle& triangle, const CutOut::Piece& piece)
{
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 side =
            at(triangle.uvs, piece.corners[(k + 1) % 3]) - at(triangle.uvs, piece.corners[k]);
        if (glm::length(side * triangle.alpha->size()) > 1.0)
            return false;
    }
    return true;
}

/// The halves of a piece, across its longest side.
std::array<CutOut::Piece, 2> halves_of(const CutTriangle& triangle, const CutOut::Piece& piece)
{
    int longest = 0;
    double length = -1.0;
    for (int k = 0; k < 3; ++k) {
        const double side = glm::distance(at(triangle.places, piece.corners[(k + 1) % 3]),
                                          at(triangle.places, piece.corners[k]));
        if (side > length) {
            length = side;
            longest = k;
        }
    }
    const int next = (longest + 1) % 3;
    const glm::dvec2 middle = 0.5 * (piece.corners[longest] + piece.corners[next]);
    std::array<CutOut::Piece, 2> halves{piece, piece};
    halves[0].corners[next] = middle;
    halves[1].corners[longest] = middle;
    return halves;
}

class Cutter {
public:
    /// Decides about a triangle, or puts it off.
    void add(std::uint32_t number, const CutTriangle& triangle, CutOut& found)
    {
        const CutOut::Piece whole{number, {{0, 0}, {1, 0}, {0, 1}}};
        const double area = area_of(triangle, whole);
        whole_area_ += area;
        const AlphaMap::Look look = look_at(triangle, whole);
        if (look == AlphaMap::Look::there) {
            kept_area_ += area;
            return;
        }
        found.replaced[number] = true;
        found.triangles.push_back(number);
        if (look == AlphaMap::Look::gone)
            return;
        triangles_.emplace(number, triangle);
        push(area, whole);
    }

    void finish(CutOut& found)
    {
        while (!open_.empty() && open_area_ > kUndecided * whole_area_) {
            found.is_coarse = open_.size() + found.pieces.size() >= kMostPieces;
            if (found.is_coarse)
                break;
            const OpenPiece next = open_.top();
            open_.pop();
            open_area_ -= next.area;
            const CutTriangle& triangle = triangles_.at(next.piece.triangle);
            if (is_one_texel(triangle, next.piece)) {
                decide(triangle, next, found);
                continue;
            }
            for (const CutOut::Piece& half : halves_of(triangle, next.piece)) {
                const AlphaMap::Look look = look_at(triangle, half);
                if (look == AlphaMap::Look::mixed)
                    push(0.5 * next.area, half);
                else if (look == AlphaMap::Look::there)
                    keep(0.5 * next.area, half, found);
            }
        }
        for (; !open_.empty(); open_.pop())
            decide(triangles_.at(open_.top().piece.triangle), open_.top(), found);
        found.share = whole_area_ > 0.0 ? std::max(0.0, 1.0 - kept_area_ / whole_area_) : 0.0;
    }

private:
    void push(double area, const CutOut::Piece& piece)
    {
        open_.push({area, count_++, piece});
        open_area_ += area;
    }
    void keep(double area, const CutOut::Piece& piece, CutOut& found)
    {
        kept_area_ += area;
        found.pieces.push_back(piece);
    }
    void decide(const CutTriangle& triangle, const OpenPiece& open, CutOut& found)
    {
        const CutOut::Piece& piece = open.piece;
        const glm::dvec2 centre = (piece.corners[0] + piece.corners[1] + piece.corners[2]) / 3.0;
        if (triangle.alpha->is_there(at(triangle.uvs, centre)))
            keep(open.area, piece, found);
    }

    std::map<std::uint32_t, CutTriangle> triangles_;
    std::priority_queue<OpenPiece> open_;
    std::uint32_t count_ = 0;
    double whole_area_ = 0.0, open_area_ = 0.0, kept_area_ = 0.0;
};

/// What a material's alpha looks like.
struct MaterialAlpha {
    std::optional<AlphaMap> map;
    bool is_gone = false;  ///< without a map: all of it
};

MaterialAlpha alpha_of(const BaseColor& material, const BaseColors& colors, CutOut& found)
{
    MaterialAlpha alpha;
    if (!material.alpha_picture) {
        alpha.is_gone = material.alpha < material.cutoff;
        return alpha;
    }
    const PictureSource& source = colors.pictures[*material.alpha_picture];
    try {
        alpha.map.emplace(
            source.file.empty() ? read_image(source.name, source.bytes) : read_image(source.file),
            material);
    } catch (const InputError& error) {
        found.notes.push_back("material " + material.name +
                              " occludes without the holes of its alpha: " + error.what());
    }
    return alpha;
}

/// Whether all corners have texture coordinates.
bool set_uvs(const Scene& scene, std::uint32_t t, const BaseColor& material, CutTriangle& triangle)
{
    if (material.uv_set >= scene.uvs.size() || scene.uvs[material.uv_set].empty())
        return false;
    const UvSet& uvs = scene.uvs[material.uv_set];
    const glm::uvec3 corners = uvs.corners.empty() ? scene.triangles[t] : uvs.corners[t];
    for (int k = 0; k < 3; ++k) {
        if (corners[k] == UvSet::kNone)
            return false;
        triangle.uvs[k] = material.uv_matrix * uvs.values[corners[k]] + material.uv_offset;
        if (!std::isfinite(triangle.uvs[k].x + triangle.uvs[k].y))
            return false;
    }
    return true;
}

}  // namespace

CutOut cut_out(const Scene& scene, const BaseColors& colors, const std::vector<bool>& wanted)
{
    CutOut found;
    std::map<std::uint32_t, MaterialAlpha> alphas;
    Cutter cutter;
    std::uint64_t without_uvs = 0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const BaseColor& material = colors.materials[colors.triangles[t]];
        if (material.opacity != Opacity::cut || (!wanted.empty() && !wanted[t]))
            continue;
        if (found.replaced.empty())
            found.replaced.assign(scene.triangles.size(), false);
        const auto [entry, is_new] = alphas.try_emplace(colors.triangles[t]);
        MaterialAlpha& alpha = entry->second;
        if (is_new)
            alpha = alpha_of(material, colors, found);
        if (!alpha.map) {
            if (alpha.is_gone) {
                found.replaced[t] = true;
                found.triangles.push_back(t);
            }
            continue;
        }
        CutTriangle triangle;
        triangle.alpha = &*alpha.map;
        for (int k = 0; k < 3; ++k)
            triangle.places[k] = scene.positions[scene.triangles[t][k]];
        if (!set_uvs(scene, t, material, triangle))
            ++without_uvs;
        else
            cutter.add(t, triangle, found);
    }
    cutter.finish(found);
    if (without_uvs > 0)
        found.notes.push_back(std::to_string(without_uvs) +
                              " triangles with holes by alpha, but without texture coordinates "
                              "occlude as whole ones");
    return found;
}

}  // namespace surfelao
