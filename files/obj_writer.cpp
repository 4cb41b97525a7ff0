#include "files/face_places.h"
#include "files/maker_mark.h"
#include "files/obj_file.h"
#include "files/obj_io.h"
#include "files/obj_materials.h"
#include "files/sidecars.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <array>
#include <optional>

namespace surfelao {
namespace {

/// What stands behind the coordinates of a vertex line: the colour's words, if there are any.
struct LineColor {
    std::array<std::string_view, 4> words;
    std::size_t count = 0;

    [[nodiscard]] std::span<const std::string_view> span() const { return {words.data(), count}; }
};

/// Reads on to the end of a vertex line, from behind z on: one number there is a weight.
LineColor read_color(TextCursor& cursor)
{
    LineColor color;
    while (!cursor.at_line_end()) {
        const std::string_view word = cursor.word();
        if (color.count < color.words.size())
            color.words[color.count++] = word;
    }
    if (color.count < 3)
        color.count = 0;
    return color;
}

void skip_coordinates(TextCursor& cursor)
{
    for (int axis = 0; axis < 3; ++axis)
        cursor.word();
}

void append_color(std::string& text, const ColorPlan& plan, std::string_view own,
                  std::size_t vertex, const Occlusion& occlusion)
{
    if (plan.what == VertexColors::keep) {
        text.append(own.empty() ? "" : " ").append(own);
        return;
    }
    const glm::vec3 numbers = plan.numbers(vertex, occlusion);
    for (int channel = 0; channel < 3; ++channel)
        append_fixed(text += ' ', numbers[channel], 6);
    if (std::ranges::count(own, ' ') == 3)  // alpha
        text.append(own.substr(own.rfind(' ')));
}

void append_mark_line(std::string& text, std::string_view mark, std::string_view line_end)
{
    if (!mark.empty())
        text.append("# ").append(mark).append(line_end);
}

/// What a map needs in the text of an OBJ.
struct MapLines {
    std::string library;                                ///< the name of the material file
    const UvSet* uvs = nullptr;                         ///< new ones; null: the text's stay
    std::vector<std::filesystem::path> libraries = {};  ///< found: those that the text had
    std::vector<std::string> used = {};                 ///< found: materials of its faces
};

void append_uv_lines(std::string& text, const UvSet& uvs, std::string_view line_end)
{
    for (const glm::dvec2& uv : uvs.values) {
        append_shortest(text += "vt ", static_cast<float>(uv.x));
        append_shortest(text += ' ', static_cast<float>(1.0 - uv.y));  // v runs up
        text += line_end;
    }
}

/// `v/vt/vn` with another vt, or none.
void append_corner(std::string& text, std::string_view word, std::optional<std::uint32_t> place)
{
    const std::size_t slash = std::min(word.find('/'), word.size());
    const std::size_t second = std::min(word.find('/', slash + 1), word.size());
    text.append(" ").append(word.substr(0, slash));
    const bool has_normal = second + 1 < word.size();
    if (place)
        append_integer(text += '/', std::int64_t{*place} + 1);
    if (has_normal)
        text.append(place ? "/" : "//").append(word.substr(second + 1));
}

/// The source's text with new colours and names of files; copies what lies between.
class TextWriter {
public:
    /// map: may be null.
    TextWriter(const ObjSource& source, const ObjSource::Own& own, const ColorPlan& plan,
               std::filesystem::path folder, MapLines* map = nullptr)
        : source_(source), own_(own), plan_(plan), folder_(std::move(folder)), map_(map)
    {
    }

    /// occlusion: empty for a map.
    std::string write(const Scene& scene, std::span<const Occlusion> occlusion,
                      std::string_view mark)
    {
        const std::string_view old = own_.text;
        if (map_ && map_->uvs)
            faces_.emplace(scene, *map_->uvs, FaceShape::polygons);
        text_.reserve(old.size() + mark.size() + occlusion.size() * 28);
        if (old.starts_with(kByteOrderMark))
            copy_to(kByteOrderMark.size());
        append_mark_line(text_, mark, line_end_of(old));
        copied_ += obj_mark(old.substr(copied_)).line.size();
        if (map_)
            text_.append("mtllib ").append(map_->library).append(line_end_of(old));
        std::size_t vertex = 0;
        TextCursor cursor("", old, kObjRules);
        while (cursor.next_line()) {
            const std::size_t begin = cursor.offset();
            const std::string_view statement = cursor.word();
            if (statement == "v") {
                replace_color(cursor, vertex, occlusion.empty() ? Occlusion{} : occlusion[vertex]);
                ++vertex;
            } else if (map_) {
                write_for_map(cursor, begin, statement);
            } else if (statement == "mtllib") {
                replace_names(cursor);
            }
        }
        copy_to(old.size());
        if (plan_.what != VertexColors::keep)
            own_.colors.append_comments(text_);
        return std::move(text_);
    }

    std::vector<std::string> missing;  ///< names of files that are not there

private:
    void copy_to(std::size_t end)
    {
        text_.append(own_.text.substr(copied_, end - copied_));
        copied_ = end;
    }

    void replace_color(TextCursor& cursor, std::size_t vertex, const Occlusion& occlusion)
    {
        skip_coordinates(cursor);
        copy_to(cursor.offset());
        append_color(text_, plan_, plan_.has_own() ? own_.colors[vertex] : "", vertex, occlusion);
        read_color(cursor);
        copied_ = cursor.offset();
        if (copied_ < own_.text.size() && own_.text[copied_] == kObjRules.comment)
            text_ += ' ';
    }

    void replace_names(TextCursor& cursor)
    {
        const std::size_t begin = cursor.offset();
        while (!cursor.at_line_end())
            cursor.word();
        copy_to(begin);
        const std::string_view names = own_.text.substr(begin, cursor.offset() - begin);
        text_ += names_from(folder_, source_.folder, names, missing);
        copied_ = cursor.offset();
    }

    void write_for_map(TextCursor& cursor, std::size_t begin, std::string_view statement)
    {
        if (statement == "mtllib") {
            for (const NamedFile& named : files_named(source_.folder, rest_of(cursor))) {
                if (named.file.empty())
                    missing.emplace_back(named.name);
                else if (std::ranges::find(map_->libraries, named.file) == map_->libraries.end())
                    map_->libraries.push_back(named.file);
            }
            drop_line(cursor, begin);
        } else if (statement == "usemtl") {
            map_->used.emplace_back(rest_of(cursor));
        } else if (statement == "vt" && map_->uvs) {
            rest_of(cursor);
            drop_line(cursor, begin);
        } else if (statement == "l" && map_->uvs) {
            replace_corners(cursor, begin, statement);
        } else if (statement == "f" || statement == "fo") {
            begin_faces(begin);
            if (map_->uvs)
                replace_corners(cursor, begin, statement);
        }
    }

    /// The words up to the end of the line, as they stand there.
    std::string_view rest_of(TextCursor& cursor)
    {
        static_cast<void>(cursor.at_line_end());  // goes to the next word
        const std::size_t begin = cursor.offset();
        std::size_t end = begin;
        while (!cursor.at_line_end()) {
            cursor.word();
            end = cursor.offset();
        }
        return own_.text.substr(begin, end - begin);
    }

    /// Leaves out the line that begins at `begin`, with its comment.
    void drop_line(const TextCursor& cursor, std::size_t begin)
    {
        copy_to(begin);
        copied_ = std::min(own_.text.find_first_of("\r\n", cursor.offset()), own_.text.size());
        copied_ += own_.text.substr(copied_).starts_with("\r\n") ? 2 : 1;
        copied_ = std::min(copied_, own_.text.size());
    }

    /// What must stand in front of the first face.
    void begin_faces(std::size_t begin)
    {
        if (has_faces_)
            return;
        has_faces_ = true;
        copy_to(begin);
        if (map_->uvs)
            append_uv_lines(text_, *map_->uvs, line_end_of(own_.text));
        if (map_->used.empty()) {
            map_->used.emplace_back(kPlainObjMaterial);
            text_.append("usemtl ").append(kPlainObjMaterial).append(line_end_of(own_.text));
        }
    }

    /// A face with its places, or what else has corners without.
    void replace_corners(TextCursor& cursor, std::size_t begin, std::string_view statement)
    {
        copy_to(begin);
        words_.clear();
        while (!cursor.at_line_end())
            words_.push_back(cursor.word());
        copied_ = cursor.offset();
        if (statement == "l" || words_.size() < 3) {
            text_ += statement;
            for (const std::string_view word : words_)
                append_corner(text_, word, {});
        } else {
            bool is_first = true;
            for (const PlacedFace& face : faces_->next()) {
                text_.append(is_first ? "" : line_end_of(own_.text)).append("f");
                is_first = false;
                for (std::size_t c = 0; c < face.corners.size(); ++c)
                    append_corner(
                        text_, words_[face.corners[c]],
                        face.places.empty() ? std::nullopt : std::optional(face.places[c]));
            }
        }
        if (copied_ < own_.text.size() && own_.text[copied_] == kObjRules.comment)
            text_ += ' ';
    }

    const ObjSource& source_;
    const ObjSource::Own& own_;
    const ColorPlan& plan_;
    std::filesystem::path folder_;
    MapLines* map_;
    std::optional<FacePlaces> faces_;
    bool has_faces_ = false;
    std::vector<std::string_view> words_;
    std::string text_;
    std::size_t copied_ = 0;  ///< bytes of the old text
};

/// Lines for a face of these vertices.
void append_faces(std::string& text, std::span<const std::uint32_t> vertices,
                  std::span<const PlacedFace> faces)
{
    for (const PlacedFace& face : faces) {
        text += 'f';
        for (std::size_t c = 0; c < face.corners.size(); ++c) {
            append_integer(text += ' ', std::int64_t{vertices[face.corners[c]]} + 1);
            if (!face.places.empty())
                append_integer(text += '/', std::int64_t{face.places[c]} + 1);
        }
        text += '\n';
    }
}

/// A new text; occlusion: empty for a map.
std::string new_obj(const Scene& scene, std::span<const Occlusion> occlusion, const ColorPlan& plan,
                    std::string_view mark, const MapLines* map = nullptr)
{
    ColorWords own;
    for (const glm::vec4& color : plan.own)
        own.add(color, ColorWords::Form::decimals);
    std::string text;
    append_mark_line(text, mark, "\n");
    if (map)
        text.append("mtllib ").append(map->library).append("\n");
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        text += 'v';
        for (int axis = 0; axis < 3; ++axis)
            append_shortest(text += ' ', scene.positions[v][axis]);
        if (plan.writes())
            append_color(text, plan, plan.has_own() ? own[v] : "", v,
                         occlusion.empty() ? Occlusion{} : occlusion[v]);
        text += '\n';
    }
    const bool has_normals = !map && scene.normals.of_vertices();
    for (std::size_t v = 0; v < scene.positions.size() && has_normals; ++v) {
        text += "vn";
        for (int axis = 0; axis < 3; ++axis)
            append_shortest(text += ' ', scene.normals.values[v][axis]);
        text += '\n';
    }
    if (map) {
        append_uv_lines(text, *map->uvs, "\n");
        text.append("usemtl ").append(kPlainObjMaterial).append("\n");
    }
    std::optional<FacePlaces> places;
    if (map)
        places.emplace(scene, *map->uvs, FaceShape::polygons);
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        if (places) {
            append_faces(text, corners, places->next());
            return;
        }
        text += 'f';
        for (const std::uint32_t corner : corners) {
            append_integer(text += ' ', std::int64_t{corner} + 1);
            if (has_normals)
                append_integer(text += "//", std::int64_t{corner} + 1);
        }
        text += '\n';
    });
    if (plan.replaces())
        own.append_comments(text);
    return text;
}

}  // namespace

ObjSource::Own ObjSource::own() const
{
    Own own{text, {}};
    if (!has_colors) {
        own.colors.deny_comments(own.text, vertex_count);
        return own;
    }
    own.text = own.colors.take_comments(text, vertex_count);
    std::string_view marked = text;
    marked.remove_prefix(marked.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    if (own.colors.size() > 0 || colors_are_baked(obj_mark(marked).mark))
        return own;
    TextCursor cursor("", text, kObjRules);
    while (cursor.next_line()) {
        if (cursor.word() != "v")
            continue;
        skip_coordinates(cursor);
        own.colors.add(read_color(cursor).span());
    }
    return own;
}

WrittenFile obj_contents(const std::filesystem::path& path, const Scene& scene,
                         std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    WrittenFile written;
    const auto plan_of = [&](std::vector<glm::vec4> own) {
        return plan_colors(options, std::move(own), OcclusionPlace::none, written.notes);
    };
    const auto* source = dynamic_cast<const ObjSource*>(scene.asset.get());
    if (!source) {
        const ColorPlan plan = plan_of(own_colors_of(scene));
        written.contents = new_obj(scene, occlusion, plan, options.mark);
        return written;
    }
    const ObjSource::Own own = source->own();
    const ColorPlan plan = plan_of(own.colors.linear());
    TextWriter writer(*source, own, plan, path.parent_path());
    written.contents = writer.write(scene, occlusion, options.mark);
    note_missing(writer.missing, written.notes);
    return written;
}

std::string original_obj(const Scene& scene)
{
    const auto& source = dynamic_cast<const ObjSource&>(*scene.asset);
    WriteOptions keeping;
    keeping.colors = VertexColors::keep;
    return obj_contents(source.folder / scene.name, scene,
                        std::vector<Occlusion>(scene.positions.size()), keeping)
        .contents;
}

ObjWithMap obj_contents_with_map(const std::filesystem::path& path, const Scene& scene,
                                 const OcclusionMap& map, const WriteOptions& options)
{
    ObjWithMap written;
    WriteOptions keeping = options;
    keeping.colors = VertexColors::keep;
    const auto plan_of = [&](std::vector<glm::vec4> own) {
        return plan_colors(keeping, std::move(own), OcclusionPlace::beside, written.notes);
    };
    const std::string picture = map_file_of(path)->filename().string();
    MapLines lines{map_materials_of(path)->filename().string(), map.uvs ? &*map.uvs : nullptr};
    std::vector<std::string> missing;
    if (const auto* source = dynamic_cast<const ObjSource*>(scene.asset.get())) {
        const ObjSource::Own own = source->own();
        const ColorPlan plan = plan_of(own.colors.linear());
        TextWriter writer(*source, own, plan, path.parent_path(), &lines);
        written.contents = writer.write(scene, {}, options.mark);
        missing = std::move(writer.missing);
        if (map.uvs && !scene.uvs.empty())
            written.notes.push_back("new texture coordinates take the place of the file's");
    } else {
        if (!lines.uvs)
            lines.uvs = &scene.uvs[map.uv_set];
        lines.used.emplace_back(kPlainObjMaterial);
        written.contents = new_obj(scene, {}, plan_of(own_colors_of(scene)), options.mark, &lines);
    }
    ObjMaterials materials = obj_materials(path.parent_path(), lines.libraries, lines.used, picture,
                                           options.mark, missing);
    written.materials = std::move(materials.text);
    if (materials.replaced > 0)
        written.notes.push_back("the map takes the place of the map_Ka of " +
                                count_text(materials.replaced, "material"));
    note_missing(missing, written.notes);
    return written;
}

}  // namespace surfelao
