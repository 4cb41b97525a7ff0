#include "files/refined_faces.h"

#include "files/own_colors.h"
#include "files/triangulate.h"
#include "surfels/number_text.h"

#include <cmath>
#include <limits>

namespace surfelao {

RefinedFaces::RefinedFaces(const Scene& scene, const Refinement& refinement)
    : scene_(scene), refinement_(refinement), polygons_(source_polygons(scene))
{
}

RefinedFaces::Face RefinedFaces::next()
{
    const std::size_t size = polygons_ ? polygons_->sizes[face_] : 3;
    const std::uint32_t first = triangle_;
    triangle_ += static_cast<std::uint32_t>(size - 2);
    corner_ += size;
    ++face_;
    bool is_cut = false, is_moved = false;
    for (std::uint32_t t = first; t < triangle_; ++t) {
        is_cut = is_cut || refinement_.splits(t);
        is_moved = is_moved || refinement_.pieces_of(t)[0] != scene_.triangles[t];
    }
    if (!is_cut && !is_moved)
        return {};
    cut_.assign(size == 3 ? 1 : 0, glm::uvec3(0, 1, 2));
    if (size > 3)
        triangulate(scene_.positions, {&polygons_->corners[corner_ - size], size}, cut_);
    triangles_.clear();
    vertices_.assign(size, kNoValue);
    for (std::uint32_t t = first; t < triangle_; ++t) {
        const glm::uvec3& corners = cut_[t - first];
        triangles_.push_back({t, corners});
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = refinement_.pieces_of(t)[0][k];
            std::uint32_t& known = vertices_[corners[k]];
            // a crease within a polygon: its triangles have different copies of the corner
            is_cut = is_cut || (known != kNoValue && known != vertex);
            known = vertex;
        }
    }
    return is_cut ? Face{triangles_, {}} : Face{{}, vertices_};
}

std::vector<std::string_view> TextRows::words(std::size_t row) const
{
    std::vector<std::string_view> words;
    TextCursor cursor("", rows_[row], rules_, 2);
    while (!cursor.at_line_end())
        words.push_back(cursor.word());
    return words;
}

glm::dvec2 numbers_of_words(std::string_view a, std::string_view b)
{
    const auto number = [](std::string_view word) {
        return number_in(word).value_or(std::numeric_limits<double>::quiet_NaN());
    };
    return {number(a), number(b)};
}

void append_middle(std::string& text, std::string_view a, std::string_view b, Rounding rounding)
{
    const glm::dvec2 ends = numbers_of_words(a, b);
    const double middle = 0.5 * ends.x + 0.5 * ends.y;
    text += ' ';
    if (!std::isfinite(middle))
        text += a;
    else if (rounding == Rounding::whole)
        append_integer(text, std::llround(middle));
    else
        append_shortest(text, middle);
}

void append_middle(std::string& text, std::span<const std::string_view> a,
                   std::span<const std::string_view> b, Triple triple)
{
    glm::dvec3 first, second;
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const glm::dvec2 ends = numbers_of_words(a[k], b[k]);
        first[axis] = ends.x;
        second[axis] = ends.y;
    }
    const glm::dvec3 middle =
        triple == Triple::place ? 0.5 * first + 0.5 * second : middle_direction(first, second);
    for (int axis = 0; axis < 3; ++axis) {
        text += ' ';
        if (triple == Triple::place)
            append_shortest(text, middle[axis]);
        else
            append_shortest(text, static_cast<float>(middle[axis]));
    }
}

}  // namespace surfelao
