#include "files/off_file.h"
#include "files/refined_faces.h"
#include "surfels/number_text.h"

#include <algorithm>

namespace surfelao {
namespace {

class OffRefiner {
public:
    OffRefiner(const Scene& scene, const Refinement& refinement, std::span<const glm::vec3> normals)
        : header_(dynamic_cast<const OffSource&>(*scene.asset).header),
          old_(dynamic_cast<const OffSource&>(*scene.asset).text),
          refinement_(refinement),
          faces_(scene, refinement)
    {
        if (!header_.has_normals)
            normals_ = normals;
    }

    std::string write()
    {
        TextCursor cursor("", old_.substr(header_.end), kOffRules, 2);
        std::string vertices;
        std::size_t copied = header_.end;
        for (std::uint64_t v = 0; v < header_.vertices; ++v) {
            cursor.next_line();
            const std::size_t begin = header_.end + cursor.offset();
            go_to_end(cursor);
            const std::size_t end = header_.end + cursor.offset();
            vertices_.add(old_.substr(begin, end - begin));
            find_bytes(vertices_.words(v));
            vertices.append(old_.substr(copied, begin - copied));
            append_row(vertices, old_.substr(begin, end - begin));
            copied = end;
        }
        const std::string faces = face_lines(cursor);
        for (const glm::uvec2& of : refinement_.parents)
            append_row(vertices.append(line_end_), middle_row(of));
        return keyword_and_counts().append(vertices).append(faces);
    }

private:
    static void go_to_end(TextCursor& cursor)
    {
        while (!cursor.at_line_end())
            cursor.word();
    }

    /// Of the next vertex, with its normal behind the coordinates where it gets one.
    void append_row(std::string& text, std::string_view row)
    {
        if (normals_.empty()) {
            text.append(row);
            return;
        }
        TextCursor cursor("", row, kOffRules, 2);
        for (int axis = 0; axis < 3; ++axis)
            cursor.word();
        text.append(row.substr(0, cursor.offset()));
        for (int axis = 0; axis < 3; ++axis)
            append_shortest(text += ' ', normals_[rows_written_][axis]);
        text.append(row.substr(cursor.offset()));
        ++rows_written_;
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
        for (std::uint64_t row = 0; row < header_.faces; ++row) {
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
            const RefinedFaces::Face face = faces_.next();
            if (face.triangles.empty() && face.vertices.empty())
                continue;
            text.append(old_.substr(copied, begin - copied));
            copied = header_.end + cursor.offset();
            std::string_view rest_of_face = old_.substr(rest, copied - rest);
            copied -= rest_of_face.size();
            rest_of_face = rest_of_face.substr(0, rest_of_face.find_last_not_of(" \t") + 1);
            copied += rest_of_face.size();
            if (face.triangles.empty())
                append_face(text, face.vertices, rest_of_face);
            bool is_first = true;
            for (const RefinedFaces::Triangle& triangle : face.triangles) {
                for (const glm::uvec3& piece : refinement_.pieces_of(triangle.number)) {
                    text.append(is_first ? "" : line_end_);
                    append_face(text, {&piece.x, 3}, rest_of_face);
                    face_count_ += is_first ? 0 : 1;
                    is_first = false;
                }
            }
        }
        return text.append(old_.substr(copied));
    }

    static void append_face(std::string& text, std::span<const std::uint32_t> vertices,
                            std::string_view rest)
    {
        append_integer(text, static_cast<std::int64_t>(vertices.size()));
        for (const std::uint32_t vertex : vertices)
            append_integer(text += ' ', vertex);
        text.append(rest);
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
        if (!normals_.empty() && header_.keyword.empty())
            text.insert(begin, std::string("NOFF").append(line_end_));
        else if (!normals_.empty())
            text.insert(begin - 3, "N");  // OFF is the last of the keyword
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
    std::span<const glm::vec3> normals_;  ///< that the file gets
    std::size_t rows_written_ = 0;        ///< with one
    TextRows vertices_{kOffRules};
    std::string_view line_end_ = line_end_of(old_);
    std::uint64_t face_count_ = 0;
    bool has_bytes_ = false;
};

}  // namespace

std::string refined_off(const Scene& scene, const Refinement& refinement,
                        std::span<const glm::vec3> normals)
{
    return OffRefiner(scene, refinement, normals).write();
}

}  // namespace surfelao
