#include "files/face_places.h"
#include "files/maker_mark.h"
#include "files/mesh_source.h"
#include "files/own_colors.h"
#include "files/ply_file.h"
#include "files/ply_io.h"
#include "files/ply_text.h"
#include "files/sidecars.h"
#include "surfels/number_text.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

namespace surfelao {
namespace {

using namespace ply;

/// What becomes of a file's faces.
struct FaceChanges {
    std::string texture;         ///< the name of a picture; empty: there is none
    const UvSet* uvs = nullptr;  ///< new coordinates; null: the file's stay
    std::size_t count = 0;       ///< rows, with new coordinates
    std::vector<std::string> new_properties = {};

    [[nodiscard]] bool drops(std::string_view property) const
    {
        return uvs && (property == "texcoord" || property == "texnumber");
    }
};

/// The header of the source with the new properties behind the others of the vertex, the mark
/// behind the format and names of files as they are reached from `folder`; older properties and
/// marks are left out.
class HeaderWriter {
public:
    HeaderWriter(const PlySource& source, const VertexChanges& changes, const FaceChanges& faces,
                 std::filesystem::path folder)
        : source_(source), changes_(changes), faces_(faces), folder_(std::move(folder))
    {
        insert(*find_element(source.header, "vertex"), property_words(changes.added));
        if (faces.uvs)
            insert(*find_element(source.header, "face"), faces.new_properties);
        std::ranges::sort(inserts_, {}, &Insert::at);
    }

    std::string write(std::string_view mark)
    {
        std::size_t inserted = 0;
        TextCursor cursor({}, old_, {});
        while (cursor.next_line()) {
            for (; inserted < inserts_.size() && cursor.offset() >= inserts_[inserted].at;
                 ++inserted) {
                copy_to(inserts_[inserted].at);
                text_ += inserts_[inserted].lines;
            }
            write_line(cursor, mark);
        }
        copy_to(old_.size());
        return std::move(text_);
    }

    std::vector<std::string> missing;  ///< names of files that are not there
    std::size_t replaced = 0;          ///< other textures

private:
    struct Insert {
        std::size_t at;
        std::string lines;
    };

    void insert(const Element& element, const std::vector<std::string>& properties)
    {
        inserts_.push_back({element.lines_end, {}});
        append_property_lines(inserts_.back().lines, properties, source_.header.newline);
    }

    void copy_to(std::size_t end)
    {
        text_.append(old_.substr(copied_, end - copied_));
        copied_ = end;
    }

    void write_line(TextCursor& cursor, std::string_view mark)
    {
        const std::size_t line_begin = cursor.offset();
        const std::string_view keyword = cursor.word();
        std::string_view last;
        if (keyword == "element") {
            element_ = cursor.word();
            if (element_ == "face" && faces_.uvs)
                replace_count(cursor);
        }
        const std::size_t words_begin = cursor.at_line_end() ? line_begin : cursor.offset();
        while (!cursor.at_line_end())
            last = cursor.word();
        const std::size_t words_end = cursor.offset();
        const std::size_t line_end = line_after(old_, words_end);
        const std::string_view words = old_.substr(words_begin, words_end - words_begin);
        const bool is_comment = keyword == "comment";
        const bool is_texture = is_comment && words.starts_with(kTextureKeyword);
        if (is_texture && !faces_.texture.empty())
            replaced += words.substr(kTextureKeyword.size() + 1) == faces_.texture ? 0 : 1;
        if ((is_comment && !command_of_mark(words).empty()) ||
            (is_texture && !faces_.texture.empty()) ||
            (keyword == "property" && ((element_ == "vertex" && changes_.drops(last)) ||
                                       (element_ == "face" && faces_.drops(last))))) {
            copy_to(line_begin);
            copied_ = line_end;
        } else if (is_texture) {
            copy_to(words_begin + kTextureKeyword.size());
            text_ += names_from(folder_, source_.folder, old_.substr(copied_, words_end - copied_),
                                missing);
            copied_ = words_end;
        } else if (keyword == "format") {
            copy_to(line_end);
            append_mark_line(text_, mark, source_.header.newline);
            append_texture_line(text_, faces_.texture, source_.header.newline);
        }
    }

    void replace_count(TextCursor& cursor)
    {
        static_cast<void>(cursor.at_line_end());  // goes to the next word
        copy_to(cursor.offset());
        append_integer(text_, static_cast<std::int64_t>(faces_.count));
        cursor.word();
        copied_ = cursor.offset();
    }

    const PlySource& source_;
    const VertexChanges& changes_;
    const FaceChanges& faces_;
    std::filesystem::path folder_;
    std::string_view old_ = std::string_view(source_.contents).substr(0, source_.header.data_begin);
    std::string text_;
    std::size_t copied_ = 0;  ///< bytes of the old header
    std::string_view element_;
    std::vector<Insert> inserts_;
};

/// The rows of the faces with places in a map; counts them.
template <class Data>
class FaceRows {
public:
    FaceRows(const PlySource& source, const Scene& scene, const UvSet& uvs)
        : source_(source),
          faces_(*find_element(source.header, "face")),
          uvs_(uvs),
          notation_(notation_of(source.form())),
          places_(scene, uvs, FaceShape::triangles),
          data_(no_name_, source.face_rows(), source.form())
    {
    }

    std::string write(FaceChanges& changes)
    {
        const std::string_view rows = source_.face_rows();
        std::size_t row_end = 0;
        for (std::uint64_t row = 0; row < faces_.count; ++row) {
            data_.begin_row(faces_, row);
            text_.append(rows.substr(row_end, data_.offset() - row_end));
            read_row(rows);
            row_end = data_.offset();
            if (corners_.size() < 3) {
                append_row(changes, nullptr);
                continue;
            }
            const std::span<const PlacedFace> placed = places_.next();
            for (const PlacedFace& face : placed) {
                if (notation_.ascii && &face != placed.data())
                    text_ += source_.header.newline;
                append_row(changes, &face);
            }
        }
        return std::move(text_.append(rows.substr(row_end)));
    }

private:
    /// Where the properties stand, and each of the vertices.
    void read_row(std::string_view rows)
    {
        old_.resize(faces_.properties.size());
        for (std::size_t p = 0; p < old_.size(); ++p) {
            const Property& property = faces_.properties[p];
            const std::size_t begin = data_.offset();
            if (p != list_) {
                skip_property(data_, property);
            } else {
                corners_.resize(read_length(data_, property));
                for (std::string_view& corner : corners_) {
                    const std::size_t at = data_.offset();
                    data_.skip(property.type, 1);
                    corner = rows.substr(at, data_.offset() - at);
                }
            }
            old_[p] = rows.substr(begin, data_.offset() - begin);
        }
    }

    /// A face, or null: one that is none, as it stands.
    void append_row(FaceChanges& changes, const PlacedFace* face)
    {
        ++changes.count;
        for (std::size_t p = 0; p < old_.size(); ++p) {
            const Property& property = faces_.properties[p];
            if (p == list_ && face && face->corners.size() < corners_.size()) {
                append_number(text_, *property.count_type,
                              static_cast<double>(face->corners.size()), notation_);
                for (const std::uint32_t corner : face->corners)
                    text_ += corners_[corner];
            } else if (!changes.drops(property.name)) {
                text_ += old_[p];
            }
        }
        append_places(text_, uvs_, face ? face->places : std::span<const std::uint32_t>(),
                      notation_);
    }

    const PlySource& source_;
    const Element& faces_;
    std::size_t list_ = index_list_of(faces_);
    const UvSet& uvs_;
    Notation notation_;
    FacePlaces places_;
    const std::string no_name_;
    Data data_;
    std::vector<std::string_view> old_, corners_;
    std::string text_;
};

/// The file of the source with what changes. occlusion: empty for a map.
template <class Data>
WrittenFile spliced(const PlySource& source, const Scene& scene,
                    std::span<const Occlusion> occlusion, FaceChanges faces,
                    const WriteOptions& options, const std::filesystem::path& folder)
{
    WrittenFile written;
    const VertexChanges changes = changes_of(source, options, !occlusion.empty(), written.notes);
    std::string face_rows;
    if (faces.uvs) {
        faces.new_properties = {kPlacesProperty};
        face_rows = FaceRows<Data>(source, scene, *faces.uvs).write(faces);
    }
    HeaderWriter header(source, changes, faces, folder);
    written.contents = header.write(options.mark);
    note_missing(header.missing, written.notes);
    if (header.replaced > 0)
        written.notes.push_back("the map takes the place of " +
                                count_text(header.replaced, "texture") + " that the file names");
    const std::string_view data = source.data();
    std::size_t copied = 0;
    const auto copy_to = [&](std::size_t end) {
        written.contents.append(data.substr(copied, end - copied));
        copied = end;
    };
    const auto write_vertices = [&] {
        copy_to(source.vertices_begin);
        copied = source.vertices_end;
        append_changed_rows(written.contents, source, occlusion, changes,
                            data.size() - copied + face_rows.size());
    };
    const auto write_faces = [&] {
        copy_to(source.faces_begin);
        copied = source.faces_end;
        written.contents.append(face_rows);
    };
    if (faces.uvs && source.faces_begin < source.vertices_begin) {
        write_faces();
        write_vertices();
    } else {
        write_vertices();
        if (faces.uvs)
            write_faces();
    }
    copy_to(data.size());
    return written;
}

WrittenFile spliced(const PlySource& source, const Scene& scene,
                    std::span<const Occlusion> occlusion, const FaceChanges& faces,
                    const WriteOptions& options, const std::filesystem::path& folder)
{
    return source.header.format == Format::ascii
               ? spliced<AsciiData>(source, scene, occlusion, faces, options, folder)
               : spliced<BinaryData>(source, scene, occlusion, faces, options, folder);
}

}  // namespace

WrittenFile ply_contents(const std::filesystem::path& path, const Scene& scene,
                         std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    if (const auto* source = dynamic_cast<const PlySource*>(scene.asset.get()))
        return spliced(*source, scene, occlusion, {}, options, path.parent_path());
    WrittenFile written;
    const NewRows rows(scene, occlusion, options, ColorForm::apart, written.notes);
    const PlyValues values{property_words(rows.columns()),
                           [&](std::string& row, std::size_t v) { rows.append(row, v, {}); }};
    written.contents = new_ply(scene, values, options.mark);
    return written;
}

std::string original_ply(const Scene& scene)
{
    const auto& source = dynamic_cast<const PlySource&>(*scene.asset);
    WriteOptions keeping;
    keeping.colors = VertexColors::keep;
    return spliced(source, scene, {}, {}, keeping, source.folder).contents;
}

WrittenFile ply_contents_with_map(const std::filesystem::path& path, const Scene& scene,
                                  const OcclusionMap& map, const WriteOptions& options)
{
    WriteOptions keeping = options;
    keeping.colors = VertexColors::keep;
    const std::string picture = map_file_of(path)->filename().string();
    const auto* source = dynamic_cast<const PlySource*>(scene.asset.get());
    const auto has_strips = [&] {
        const Element* strips = find_element(source->header, "tristrips");
        return strips && strips->count > 0;
    };
    if (source && !(map.uvs && has_strips())) {
        WrittenFile written = spliced(*source, scene, {}, {picture, map.uvs ? &*map.uvs : nullptr},
                                      keeping, path.parent_path());
        if (map.uvs && !scene.uvs.empty())
            written.notes.push_back("new texture coordinates take the place of the file's");
        return written;
    }
    WrittenFile written;
    if (source)
        written.notes.push_back("strips become faces, and only coordinates and colours are kept");
    constexpr const char* kColor[] = {"red", "green", "blue"};
    const ColorPlan plan =
        plan_colors(keeping, own_colors_of(scene), OcclusionPlace::beside, written.notes);
    PlyValues values;
    for (std::size_t c = 0; c < 3 && plan.has_own(); ++c)
        values.properties.push_back(std::string("uchar ") + kColor[c]);
    values.append = [&](std::string& row, std::size_t v) {
        const glm::vec3 numbers = plan.has_own() ? numbers_of(plan.own[v]) : glm::vec3(0.0f);
        for (int c = 0; c < 3 && plan.has_own(); ++c)
            append_number(row, Type::uint8, byte_of(numbers[c]), {});
    };
    const PlyTexture texture{picture, map.uvs ? *map.uvs : scene.uvs[map.uv_set]};
    written.contents = new_ply(scene, values, options.mark, PlyCoordinates::near_enough, &texture);
    return written;
}

bool names_our_texture(const std::filesystem::path& path, std::string_view picture)
{
    if (command_of_mark(read_mark(path)) != "bake")
        return false;
    std::string wanted;
    append_texture_line(wanted, picture, "");
    std::ifstream file(path, std::ios::binary);
    for (std::string line; std::getline(file, line) && !line.starts_with("end_header");) {
        if (line == wanted || line == wanted + '\r')
            return true;
    }
    return false;
}

}  // namespace surfelao
