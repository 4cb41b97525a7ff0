#include "files/obj_file.h"
#include "files/refined_faces.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

namespace surfelao {
namespace {

/// What a corner names by numbers, counted from 1; 0: nothing that there is.
struct ObjCorner {
    std::uint32_t vertex = 0, uv = 0, normal = 0;
};

/// The values of one statement, v, vt or vn, and their middles.
class ObjRows {
public:
    ObjRows(std::string_view statement, std::string_view line_end)
        : statement_(statement), line_end_(line_end)
    {
    }

    /// One of the file.
    void add(std::string_view row) { rows_.add(row); }
    void end_of_file() { file_count_ = rows_.size(); }

    /// The number, counted from 1, of the middle of two.
    std::uint32_t middle(std::uint32_t a, std::uint32_t b)
    {
        if (a == 0 || b == 0)
            return 0;
        if (a == b)
            return a;
        const auto [found, is_new] =
            middles_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(rows_.size() + 1));
        if (is_new)
            add_middle(a - 1, b - 1);
        return found->second;
    }

    /// A new one; returns its number, counted from 1.
    std::uint32_t add_new(std::string row)
    {
        added_.append(statement_).append(rows_.add_own(std::move(row))).append(line_end_);
        return static_cast<std::uint32_t>(rows_.size());
    }

    void add_middle(std::size_t of_a, std::size_t of_b)
    {
        const std::vector<std::string_view> a = rows_.words(of_a), b = rows_.words(of_b);
        const std::size_t count = std::min(a.size(), b.size());
        std::string row;
        std::size_t at = 0;
        if (statement_ != "vt") {
            append_middle(row, a, b, statement_ == "v" ? Triple::place : Triple::direction);
            at = 3;
        }
        for (; at < count; ++at)
            append_middle(row, a[at], b[at]);
        add_new(std::move(row));
    }

    /// What a word names after so many rows of the file have been seen; 0: none that there is.
    [[nodiscard]] std::uint32_t number_of(std::string_view word, std::size_t seen) const
    {
        std::int64_t number = 0;
        word.remove_prefix(word.starts_with('+') ? 1 : 0);
        std::from_chars(word.data(), word.data() + word.size(), number);
        if (number < 0)
            number += static_cast<std::int64_t>(seen) + 1;
        const bool is_one = number > 0 && number <= static_cast<std::int64_t>(file_count_);
        return is_one ? static_cast<std::uint32_t>(number) : 0;
    }

    /// Lines of the middles.
    [[nodiscard]] const std::string& added() const { return added_; }

private:
    std::string_view statement_, line_end_;
    TextRows rows_{kObjRules};
    std::size_t file_count_ = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
    std::string added_;
};

class ObjRefiner {
public:
    ObjRefiner(const Scene& scene, const Refinement& refinement, std::span<const glm::vec3> normals)
        : scene_(scene),
          old_(dynamic_cast<const ObjSource&>(*scene.asset).text),
          refinement_(refinement),
          faces_(scene, refinement),
          normals_(normals),
          numbers_of_normals_(normals.size(), 0)
    {
    }

    /// The file's lines up to its first face; those of vertices that stand behind it; new ones; the
    /// rest.
    std::string write()
    {
        read_rows();
        for (const glm::uvec2& of : refinement_.parents)
            rows_[0].add_middle(of.x, of.y);
        TextCursor cursor("", old_, kObjRules);
        while (cursor.next_line()) {
            const std::size_t begin = cursor.offset();
            const std::string_view statement = cursor.word();
            if (const std::optional<std::size_t> kind = kind_of(statement)) {
                ++seen_[*kind];
                if (first_element_)
                    move_line(cursor, begin);
            } else if (is_element(statement)) {
                if (!first_element_) {
                    copy_to(begin);
                    first_element_ = text_.size();
                }
                write_element(cursor, begin, statement);
            }
        }
        copy_to(old_.size());
        for (const ObjRows& rows : rows_)
            moved_ += rows.added();
        return text_.insert(*first_element_, moved_);
    }

private:
    static std::optional<std::size_t> kind_of(std::string_view statement)
    {
        constexpr std::string_view kKinds[] = {"v", "vt", "vn"};
        const auto found = std::ranges::find(kKinds, statement);
        if (found == std::end(kKinds))
            return std::nullopt;
        return static_cast<std::size_t>(found - std::begin(kKinds));
    }

    static bool is_face(std::string_view statement)
    {
        return statement == "f" || statement == "fo";
    }

    static bool is_element(std::string_view statement)
    {
        return is_face(statement) || statement == "l" || statement == "p";
    }

    void read_rows()
    {
        TextCursor cursor("", old_, kObjRules);
        while (cursor.next_line()) {
            const std::optional<std::size_t> kind = kind_of(cursor.word());
            if (!kind)
                continue;
            const std::size_t begin = cursor.offset();
            while (!cursor.at_line_end())
                cursor.word();
            rows_[*kind].add(old_.substr(begin, cursor.offset() - begin));
        }
        for (ObjRows& rows : rows_)
            rows.end_of_file();
    }

    void copy_to(std::size_t end)
    {
        text_.append(old_.substr(copied_, end - copied_));
        copied_ = end;
    }

    /// A line of a vertex that stands behind a face.
    void move_line(TextCursor& cursor, std::size_t begin)
    {
        copy_to(begin);
        while (!cursor.at_line_end())
            cursor.word();
        moved_.append(old_.substr(begin, cursor.offset() - begin)).append(line_end_);
        copied_ = std::min(old_.find_first_of("\r\n", cursor.offset()), old_.size());
        copied_ += old_.substr(copied_).starts_with("\r\n") ? 2 : 1;
        copied_ = std::min(copied_, old_.size());
    }

    /// A face, a line or points: where some of their numbers change.
    void write_element(TextCursor& cursor, std::size_t begin, std::string_view statement)
    {
        std::vector<ObjCorner> corners;
        bool counts_back = false;
        while (!cursor.at_line_end()) {
            const std::string_view word = cursor.word();
            counts_back = counts_back || word.find('-') != word.npos;
            corners.push_back(corner_of(word));
        }
        RefinedFaces::Face face;
        bool is_changed = counts_back;
        if (is_face(statement) && corners.size() >= 3) {
            face = faces_.next();
            is_changed = is_changed || !face.triangles.empty() || !face.vertices.empty();
            for (std::size_t c = 0; c < corners.size() && face.triangles.empty(); ++c) {
                if (!face.vertices.empty())
                    corners[c].vertex = face.vertices[c] + 1;
                is_changed = give_normal(corners[c]) || is_changed;
            }
        }
        if (!is_changed)
            return;
        copy_to(begin);
        copied_ = cursor.offset();
        if (face.triangles.empty()) {
            text_ += statement;
            for (const ObjCorner& corner : corners)
                append_corner(corner);
        }
        bool is_first = true;
        for (const RefinedFaces::Triangle& triangle : face.triangles) {
            const PieceValues<ObjCorner> values = values_of(triangle, corners);
            for (const glm::uvec3& piece : refinement_.pieces_of(triangle.number)) {
                text_.append(is_first ? "" : line_end_).append("f");
                is_first = false;
                for (int k = 0; k < 3; ++k) {
                    ObjCorner corner = values[piece[k]];
                    give_normal(corner);
                    append_corner(corner);
                }
            }
        }
        if (copied_ < old_.size() && old_[copied_] == kObjRules.comment)
            text_ += ' ';
    }

    /// That of its vertex, where it has none of the file. Returns whether it got one.
    bool give_normal(ObjCorner& corner)
    {
        if (corner.normal > 0 || normals_.empty())
            return false;
        const glm::vec3& normal = normals_[corner.vertex - 1];
        if (normal == glm::vec3(0.0f))
            return false;
        std::uint32_t& number = numbers_of_normals_[corner.vertex - 1];
        if (number == 0) {
            std::string row;
            for (int axis = 0; axis < 3; ++axis)
                append_shortest(row += ' ', normal[axis]);
            number = rows_[2].add_new(std::move(row));
        }
        corner.normal = number;
        return true;
    }

    [[nodiscard]] ObjCorner corner_of(std::string_view word) const
    {
        const std::size_t slash = std::min(word.find('/'), word.size());
        const std::size_t second = std::min(word.find('/', slash + 1), word.size());
        const auto number = [&](std::size_t kind, std::size_t begin, std::size_t end) {
            return begin < end ? rows_[kind].number_of(word.substr(begin, end - begin), seen_[kind])
                               : 0;
        };
        return {number(0, 0, slash), number(1, slash + 1, second),
                number(2, second + 1, word.size())};
    }

    PieceValues<ObjCorner> values_of(const RefinedFaces::Triangle& triangle,
                                     const std::vector<ObjCorner>& corners)
    {
        const glm::uvec3& at = triangle.corners;
        PieceValues<ObjCorner> values(refinement_, triangle.number,
                                      scene_.triangles[triangle.number],
                                      {corners[at.x], corners[at.y], corners[at.z]},
                                      [&](const ObjCorner& a, const ObjCorner& b) {
                                          return ObjCorner{0, rows_[1].middle(a.uv, b.uv),
                                                           rows_[2].middle(a.normal, b.normal)};
                                      });
        values.for_each(
            [](std::uint32_t vertex, ObjCorner& corner) { corner.vertex = vertex + 1; });
        return values;
    }

    void append_corner(const ObjCorner& corner)
    {
        append_integer(text_ += ' ', corner.vertex);
        if (corner.uv > 0)
            append_integer(text_ += '/', corner.uv);
        if (corner.normal > 0)
            append_integer(text_.append(corner.uv > 0 ? "/" : "//"), corner.normal);
    }

    const Scene& scene_;
    std::string_view old_;
    const Refinement& refinement_;
    RefinedFaces faces_;
    std::span<const glm::vec3> normals_;             ///< of vertices, for corners without
    std::vector<std::uint32_t> numbers_of_normals_;  ///< counted from 1; 0: has no line yet
    std::string_view line_end_ = line_end_of(old_);
    ObjRows rows_[3] = {{"v", line_end_}, {"vt", line_end_}, {"vn", line_end_}};
    std::size_t seen_[3] = {0, 0, 0};           ///< rows of the file so far
    std::optional<std::size_t> first_element_;  ///< where it begins in the new text
    std::string moved_, text_;
    std::size_t copied_ = 0;  ///< bytes of the old text
};

}  // namespace

std::string refined_obj(const Scene& scene, const Refinement& refinement,
                        std::span<const glm::vec3> normals)
{
    return ObjRefiner(scene, refinement, normals).write();
}

}  // namespace surfelao
