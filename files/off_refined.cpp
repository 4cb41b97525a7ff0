#include "files/off_file.h"
#include "files/refined_faces.h"
#include "surfels/number_text.h"

#include <algorithm>

namespace surfelao {
namespace {

class OffRefiner {
public:
    OffRefiner(const Scene& scene, const Refinement& refinement)
        : header_(dynamic_cast<const OffSource&>(*scene.asset).header),
          old_(dynamic_cast<const OffSource&>(*scene.asset).text),
          refinement_(refinement),
          faces_(scene, refinement)
    {
    }

    std::string write()
    {
        TextCursor cursor("", old_.substr(header_.end), kOffRules, 2);
        for (std::uint64_t v = 0; v < header_.vertices; ++v) {
            cursor.next_line();
            const std::size_t begin = cursor.offset();
            go_to_end(cursor);
            vertices_.add(old_.substr(header_.end + begin, cursor.offset() - begin));
            find_bytes(vertices_.words(v));
        }
        const std::size_t vertices_end = header_.end + cursor.offset();
        const std::string faces = face_lines(cursor);
        std::string text = keyword_and_counts();
        text.append(old_.substr(header_.end, vertices_end - header_.end));
        for (const glm::uvec2& of : refinement_.parents)
            text.append(line_end_).append(middle_row(of));
        return text.append(faces);
    }

private:
    static void go_to_end(TextCursor& cursor)
    {
        while (!cursor.at_line_end())
            cursor.word();
    }

    /// Of a vertex of so many words, whose colour would begin at `first`.
    [[nodiscard]] std::size_t color_words(std::size_t count, std::size_t first) const
    {
        return static_cast<std::size_t>(header_.color_words(static_cast<int>(count - first)));
    }

    /// Whether colours are numbers up to 255.
    void find_bytes(const std::vector<std::string_view>& words)
    {
        const std::size_t first = header_.has_normals && words.size() >= 6 ? 6 : 3;
        for (std::size_t k = first; k < first + color_words(words.size(), first); ++k)
            has_bytes_ = has_bytes_ || number_in(words[k]).value_or(0.0) > kLargestOfUnit;
    }

    /// From behind the vertices on.
    std::string face_lines(TextCursor& cursor)
    {
        std::string text;
        std::size_t copied = header_.end + cursor.offset();
        face_count_ = header_.faces;
        for (std::uint64_t face = 0; face < header_.faces; ++face) {
            cursor.next_line();
            const std::size_t begin = header_.end + cursor.offset();
            const std::int64_t size = cursor.integer({});
            std::vector<std::string_view> corners;
            for (std::int64_t i = 0; i < size; ++i)
                corners.push_back(cursor.word());
            const std::size_t rest = header_.end + cursor.offset();
            go_to_end(cursor);
            if (size < 3)
                continue;
            const std::span<const RefinedFaces::Triangle> triangles = faces_.next();
            if (triangles.empty())
                continue;
            text.append(old_.substr(copied, begin - copied));
            copied = header_.end + cursor.offset();
            std::string_view rest_of_face = old_.substr(rest, copied - rest);
            copied -= rest_of_face.size();
            rest_of_face = rest_of_face.substr(0, rest_of_face.find_last_not_of(" \t") + 1);
            copied += rest_of_face.size();
            bool is_first = true;
            for (const RefinedFaces::Triangle& triangle : triangles) {
                for (const glm::uvec3& piece : refinement_.pieces_of(triangle.number)) {
                    text.append(is_first ? "" : line_end_).append("3");
                    for (int k = 0; k < 3; ++k)
                        append_integer(text += ' ', piece[k]);
                    text.append(rest_of_face);
                    face_count_ += is_first ? 0 : 1;
                    is_first = false;
                }
            }
        }
        return text.append(old_.substr(copied));
    }

    [[nodiscard]] std::string keyword_and_counts() const
    {
        std::size_t begin = old_.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
        if (!header_.keyword.empty())
            begin = static_cast<std::size_t>(header_.keyword.data() - old_.data()) +
                    header_.keyword.size();
        TextCursor cursor("", old_.substr(begin), kOffRules, 2);
        if (header_.keyword.empty() || cursor.at_line_end())
            cursor.next_line();
        std::string text(old_.substr(0, begin + cursor.offset()));
        text.append(header_.is_glued ? " " : "");
        append_integer(text, static_cast<std::int64_t>(header_.vertices) +
                                 static_cast<std::int64_t>(refinement_.parents.size()));
        append_integer(text += ' ', static_cast<std::int64_t>(face_count_));
        return text.append(" 0");
    }

    std::string_view middle_row(const glm::uvec2& of)
    {
        const std::vector<std::string_view> a = vertices_.words(of.x), b = vertices_.words(of.y);
        const std::size_t count = std::min(a.size(), b.size());
        std::string row;
        append_middle(row, a, b, Triple::place);
        std::size_t at = 3;
        if (header_.has_normals && count >= 6) {
            append_middle(row, std::span(a).subspan(3), std::span(b).subspan(3), Triple::direction);
            at = 6;
        }
        const std::size_t colors_end = at + color_words(count, at);
        for (; at < count; ++at)
            append_middle(row, a[at], b[at],
                          has_bytes_ && at < colors_end ? Rounding::whole : Rounding::none);
        row.erase(0, 1);  // a blank
        return vertices_.add_own(std::move(row));
    }

    const OffHeader& header_;
    std::string_view old_;
    const Refinement& refinement_;
    RefinedFaces faces_;
    TextRows vertices_{kOffRules};
    std::string_view line_end_ = line_end_of(old_);
    std::uint64_t face_count_ = 0;
    bool has_bytes_ = false;
};

}  // namespace

std::string refined_off(const Scene& scene, const Refinement& refinement)
{
    return OffRefiner(scene, refinement).write();
}

}  // namespace surfelao
