#include "files/ply_io.h"
#include "files/ply_text.h"
#include "files/refined_faces.h"
#include "surfels/number_text.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace surfelao {
namespace {

using namespace ply;

constexpr std::array<const char*, 3> kNormal{"nx", "ny", "nz"};

/// Three scalars that are a vector; none where one is missing.
std::vector<std::size_t> triple_of(const Element& element, std::array<const char*, 3> names)
{
    std::vector<std::size_t> found;
    for (const char* name : names) {
        found.push_back(find_scalar(element, name));
        if (found.back() == element.properties.size())
            return {};
    }
    return found;
}

/// The rows of a file's vertices and, behind them, new ones.
template <class Data>
class PlyVertices {
public:
    PlyVertices(const PlySource& source, const Element& vertices)
        : header_(source.header),
          vertices_(vertices),
          notation_(notation_of(header_.form())),
          place_(triple_of(vertices, {"x", "y", "z"})),
          normal_(triple_of(vertices, kNormal)),
          text_(source.vertex_rows())
    {
        Data data(no_name_, text_, header_.form());
        for (std::uint64_t row = 0; row < vertices_.count; ++row) {
            data.begin_row(vertices_, row);
            begins_.push_back(data.offset());
            for (const Property& property : vertices_.properties)
                skip_property(data, property);
            ends_.push_back(data.offset());
        }
    }

    /// normals: put behind what each row has; empty: none.
    std::string write(const Refinement& refinement, std::span<const glm::vec3> normals)
    {
        for (const glm::uvec2& of : refinement.parents)
            append_middle_row(of);
        if (normals.empty())
            return std::move(text_);
        std::string text;
        std::size_t copied = 0;
        for (std::size_t row = 0; row < ends_.size(); ++row) {
            text.append(text_, copied, ends_[row] - copied);
            copied = ends_[row];
            for (int axis = 0; axis < 3; ++axis)
                append_number(text, Type::float32, normals[row][axis], notation_);
        }
        return text.append(text_, copied);
    }

private:
    /// One property of a row.
    struct Cell {
        double number = 0.0;  ///< of a scalar
        std::string list;     ///< as it stands
    };

    std::vector<Cell> read(std::uint32_t row) const
    {
        const std::string_view text = std::string_view(text_).substr(begins_[row]);
        Data data(no_name_, text, header_.form());
        data.begin_row(vertices_, row);
        std::vector<Cell> cells;
        for (const Property& property : vertices_.properties) {
            Cell& cell = cells.emplace_back();
            if (!property.count_type) {
                cell.number = data.loose_number(property.type);
                continue;
            }
            const std::size_t begin = data.offset();
            skip_property(data, property);
            cell.list = text.substr(begin, data.offset() - begin);
            if (notation_.ascii && !cell.list.starts_with(' '))
                cell.list.insert(0, 1, ' ');
        }
        return cells;
    }

    void append_middle_row(const glm::uvec2& of)
    {
        const std::vector<Cell> first = read(of.x), second = read(of.y);
        std::vector<Cell> middle = first;
        for (std::size_t p = 0; p < middle.size(); ++p) {
            middle[p].number = 0.5 * first[p].number + 0.5 * second[p].number;
            if (!std::isfinite(middle[p].number))
                middle[p].number = first[p].number;
        }
        if (!normal_.empty()) {
            const auto vector = [&](const std::vector<Cell>& cells) {
                return glm::dvec3(cells[normal_[0]].number, cells[normal_[1]].number,
                                  cells[normal_[2]].number);
            };
            const glm::dvec3 direction = middle_direction(vector(first), vector(second));
            for (int axis = 0; axis < 3; ++axis)
                middle[normal_[static_cast<std::size_t>(axis)]].number = direction[axis];
        }
        text_.append(notation_.ascii ? header_.newline : "");
        begins_.push_back(text_.size());
        std::string row;
        for (std::size_t p = 0; p < middle.size(); ++p) {
            const Property& property = vertices_.properties[p];
            const bool is_place = std::ranges::find(place_, p) != place_.end();
            if (property.count_type)
                row += middle[p].list;
            else if (notation_.ascii && is_place)  // their words may hold more than a float
                append_shortest(row += ' ', middle[p].number);
            else
                append_number(row, property.type, middle[p].number, notation_);
        }
        text_ += notation_.ascii ? row.substr(1) : row;
        ends_.push_back(text_.size());
    }

    const Header& header_;
    const Element& vertices_;
    Notation notation_;
    std::vector<std::size_t> place_, normal_;  ///< properties
    const std::string no_name_;
    std::string text_;
    std::vector<std::size_t> begins_, ends_;  ///< of the rows
};

/// The rows of a file's faces with pieces of triangles.
template <class Data>
class PlyFaces {
public:
    PlyFaces(const PlySource& source, const Scene& scene, const Refinement& refinement)
        : source_(source),
          faces_(*find_element(source.header, "face")),
          scene_(scene),
          refinement_(refinement),
          notation_(notation_of(source.form())),
          refined_(scene, refinement),
          data_(no_name_, source.face_rows(), source.form())
    {
        for (places_ = 0; places_ < faces_.properties.size(); ++places_) {
            if (faces_.properties[places_].name == "texcoord" &&
                faces_.properties[places_].count_type)
                break;
        }
    }

    /// index_type: of vertices, where the file's own is too small.
    std::string write(std::optional<Type> index_type)
    {
        index_type_ = index_type.value_or(faces_.properties[list_].type);
        const std::string_view rows = source_.face_rows();
        std::size_t row_end = 0;
        for (std::uint64_t row = 0; row < faces_.count; ++row) {
            data_.begin_row(faces_, row);
            text_.append(rows.substr(row_end, data_.offset() - row_end));
            const std::size_t row_begin = data_.offset();
            read_row(rows);
            row_end = data_.offset();
            const RefinedFaces::Face face =
                corners_.size() < 3 ? RefinedFaces::Face() : refined_.next();
            ++count;
            if (!face.triangles.empty())
                append_pieces(face.triangles);
            else if (index_type || !face.vertices.empty())
                append_row(face.vertices.empty() ? corners_ : face.vertices,
                           old_[places_ < old_.size() ? places_ : list_]);
            else
                text_.append(rows.substr(row_begin, row_end - row_begin));
        }
        return std::move(text_.append(rows.substr(row_end)));
    }

    std::uint64_t count = 0;  ///< of the rows

private:
    void read_row(std::string_view rows)
    {
        old_.resize(faces_.properties.size());
        corners_.clear();
        uvs_.clear();
        for (std::size_t p = 0; p < old_.size(); ++p) {
            const Property& property = faces_.properties[p];
            const std::size_t begin = data_.offset();
            if (p != list_ && p != places_) {
                skip_property(data_, property);
            } else {
                for (std::uint64_t left = read_length(data_, property); left > 0; --left) {
                    if (p == list_)
                        corners_.push_back(
                            static_cast<std::uint32_t>(data_.integer(property.type)));
                    else
                        uvs_.push_back(data_.loose_number(property.type));
                }
            }
            old_[p] = rows.substr(begin, data_.offset() - begin);
        }
    }

    void append_pieces(std::span<const RefinedFaces::Triangle> triangles)
    {
        const bool has_uvs = uvs_.size() == 2 * corners_.size();
        const bool keeps = places_ < old_.size() && !has_uvs;
        bool is_first = true;
        for (const RefinedFaces::Triangle& triangle : triangles) {
            std::array<glm::dvec2, 3> at{};
            for (int k = 0; k < 3 && has_uvs; ++k)
                at[static_cast<std::size_t>(k)] = {uvs_[2 * triangle.corners[k]],
                                                   uvs_[2 * triangle.corners[k] + 1]};
            const PieceValues<glm::dvec2> uvs(
                refinement_, triangle.number, scene_.triangles[triangle.number], at,
                [](const glm::dvec2& a, const glm::dvec2& b) { return 0.5 * a + 0.5 * b; });
            for (const glm::uvec3& piece : refinement_.pieces_of(triangle.number)) {
                if (!is_first) {
                    text_.append(notation_.ascii ? source_.header.newline : "");
                    ++count;
                }
                is_first = false;
                std::string places;
                if (has_uvs) {
                    const Property& property = faces_.properties[places_];
                    append_number(places, *property.count_type, 6.0, notation_);
                    for (int k = 0; k < 3; ++k) {
                        append_number(places, property.type, uvs[piece[k]].x, notation_);
                        append_number(places, property.type, uvs[piece[k]].y, notation_);
                    }
                } else if (keeps) {
                    places = old_[places_];
                }
                append_row({&piece.x, 3}, places);
            }
        }
    }

    /// places: what stands for `texcoord`, if there is one.
    void append_row(std::span<const std::uint32_t> corners, std::string_view places)
    {
        const std::size_t begin = text_.size();
        for (std::size_t p = 0; p < old_.size(); ++p) {
            if (p == list_) {
                append_number(text_, *faces_.properties[p].count_type,
                              static_cast<double>(corners.size()), notation_);
                for (const std::uint32_t corner : corners)
                    append_number(text_, index_type_, corner, notation_);
            } else {
                text_ += p == places_ ? places : old_[p];
            }
        }
        if (notation_.ascii && text_[begin] == ' ')
            text_.erase(begin, 1);
    }

    const PlySource& source_;
    const Element& faces_;
    const Scene& scene_;
    const Refinement& refinement_;
    Notation notation_;
    RefinedFaces refined_;
    const std::string no_name_;
    Data data_;
    std::size_t list_ = index_list_of(faces_);
    std::size_t places_ = 0;  ///< which property is `texcoord`; none: past the last
    Type index_type_ = Type::int32;
    std::vector<std::string_view> old_;
    std::vector<std::uint32_t> corners_;
    std::vector<double> uvs_;
    std::string text_;
};

/// The type that indices must have now, if the file's is too small.
std::optional<Type> wider_type(const Property& list, std::size_t vertices)
{
    const std::size_t bits =
        8 * size_of(list.type) -
        (list.type == Type::int8 || list.type == Type::int16 || list.type == Type::int32 ? 1 : 0);
    if (bits >= 31 || vertices <= std::size_t{1} << bits)
        return std::nullopt;
    return Type::int32;
}

/// What is new in a header.
struct HeaderChanges {
    std::uint64_t vertices = 0, faces = 0;  ///< how many
    std::optional<Type> index_type;         ///< where the file's is too small
    bool adds_normals = false;
};

std::string new_header(const PlySource& source, const HeaderChanges& changes)
{
    const std::string_view old =
        std::string_view(source.contents).substr(0, source.header.data_begin);
    const std::string_view list = [&] {
        const Element& element = *find_element(source.header, "face");
        return std::string_view(element.properties[index_list_of(element)].name);
    }();
    std::string text;
    std::size_t copied = 0;
    TextCursor cursor({}, old, {});
    std::string_view element;
    std::size_t normals_at =
        changes.adds_normals ? find_element(source.header, "vertex")->lines_end : old.npos;
    while (cursor.next_line()) {
        if (cursor.offset() >= normals_at) {
            text.append(old.substr(copied, normals_at - copied));
            copied = normals_at;
            for (const char* name : kNormal)
                text.append("property float ").append(name).append(source.header.newline);
            normals_at = old.npos;
        }
        const std::string_view keyword = cursor.word();
        if (keyword == "element") {
            element = cursor.word();
            if (element != "vertex" && element != "face")
                continue;
            static_cast<void>(cursor.at_line_end());  // goes to the next word
            text.append(old.substr(copied, cursor.offset() - copied));
            append_integer(text, static_cast<std::int64_t>(element == "vertex" ? changes.vertices
                                                                               : changes.faces));
            cursor.word();
            copied = cursor.offset();
        } else if (keyword == "property" && element == "face" && changes.index_type) {
            cursor.word();
            cursor.word();
            static_cast<void>(cursor.at_line_end());
            const std::size_t begin = cursor.offset();
            cursor.word();
            const std::size_t end = cursor.offset();
            if (cursor.word() != list)
                continue;
            text.append(old.substr(copied, begin - copied)).append(name_of(*changes.index_type));
            copied = end;
        }
    }
    return text.append(old.substr(copied));
}

template <class Data>
std::string refined(const PlySource& source, const Scene& scene, const Refinement& refinement,
                    std::span<const glm::vec3> normals)
{
    const Element& vertices = *find_element(source.header, "vertex");
    const Element& faces = *find_element(source.header, "face");
    const std::size_t vertex_count = scene.positions.size() + refinement.parents.size();
    const std::optional<Type> index_type =
        wider_type(faces.properties[index_list_of(faces)], vertex_count);
    const auto has = [&](const char* name) {
        return find_scalar(vertices, name) < vertices.properties.size();
    };
    if (std::ranges::any_of(kNormal, has))
        normals = {};
    const std::string vertex_rows = PlyVertices<Data>(source, vertices).write(refinement, normals);
    PlyFaces<Data> face_writer(source, scene, refinement);
    const std::string face_rows = face_writer.write(index_type);
    std::string text =
        new_header(source, {vertex_count, face_writer.count, index_type, !normals.empty()});
    const std::string_view data = source.data();
    const bool vertices_first = source.vertices_begin < source.faces_begin;
    const std::size_t first_begin = std::min(source.vertices_begin, source.faces_begin);
    const std::size_t first_end = vertices_first ? source.vertices_end : source.faces_end;
    const std::size_t last_begin = std::max(source.vertices_begin, source.faces_begin);
    const std::size_t last_end = vertices_first ? source.faces_end : source.vertices_end;
    return text.append(data.substr(0, first_begin))
        .append(vertices_first ? vertex_rows : face_rows)
        .append(data.substr(first_end, last_begin - first_end))
        .append(vertices_first ? face_rows : vertex_rows)
        .append(data.substr(last_end));
}

}  // namespace

std::string refined_ply(const Scene& scene, const Refinement& refinement,
                        std::span<const glm::vec3> normals)
{
    const auto& source = dynamic_cast<const PlySource&>(*scene.asset);
    return source.header.format == Format::ascii
               ? refined<AsciiData>(source, scene, refinement, normals)
               : refined<BinaryData>(source, scene, refinement, normals);
}

}  // namespace surfelao
