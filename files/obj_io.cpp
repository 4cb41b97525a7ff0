#include "files/obj_io.h"

#include "files/maker_mark.h"
#include "files/mesh_source.h"
#include "files/text_cursor.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <algorithm>

namespace surfelao {
namespace {

constexpr TextRules kObjRules{.comment = '#', .continuation = true};

class ObjSource : public MeshSource {
public:
    std::string text;
};

/// The largest vertex index that faces use, and where: the vertex may come later in the file.
struct Farthest {
    std::int64_t index = -1;
    std::uint64_t line = 0;
};

glm::dvec3 read_vertex(TextCursor& cursor)
{
    glm::dvec3 position;
    for (int axis = 0; axis < 3; ++axis)
        position[axis] = cursor.number("a coordinate of the vertex");
    int more = 0;
    for (; !cursor.at_line_end(); ++more)
        cursor.number("a number");
    if (more == 2 || more > 4) {
        cursor.fail("the vertex has " + std::to_string(3 + more) +
                    " numbers, but x y z, w and a colour are 3, 4, 6 or 7");
    }
    return position;
}

/// The vertex of `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 0.
std::int64_t read_corner(const TextCursor& cursor, std::string_view word, std::size_t vertex_count)
{
    const std::size_t slash = word.find('/');
    const std::int64_t number = cursor.integer_of(word.substr(0, slash));
    if (slash != std::string_view::npos) {
        const std::string_view rest = word.substr(slash + 1);
        const std::size_t second = rest.find('/');
        const std::string_view texture = rest.substr(0, second);
        if (!texture.empty())
            cursor.integer_of(texture);
        if (second != std::string_view::npos && second + 1 < rest.size())
            cursor.integer_of(rest.substr(second + 1));
    }
    if (number > 0)
        return number - 1;
    if (number == 0)
        cursor.fail("the face uses vertex 0, but vertices are counted from 1");
    const std::int64_t index = static_cast<std::int64_t>(vertex_count) + number;
    if (index < 0) {
        cursor.fail("the face uses vertex " + std::to_string(number) + ", but there are " +
                    std::to_string(vertex_count) + " vertices so far");
    }
    return index;
}

}  // namespace

Scene read_obj(const std::string& file_name, std::string contents)
{
    const auto source = std::make_shared<ObjSource>();
    source->text = std::move(contents);
    std::vector<glm::dvec3> positions;
    Polygons polygons;
    Farthest farthest;
    TextCursor cursor(file_name, source->text, kObjRules);
    while (cursor.next_line()) {
        const std::string_view statement = cursor.word();
        if (statement == "v") {
            positions.push_back(read_vertex(cursor));
        } else if (statement == "f" || statement == "fo") {
            std::uint32_t size = 0;
            for (; !cursor.at_line_end(); ++size) {
                const std::int64_t index = read_corner(cursor, cursor.word(), positions.size());
                if (index > farthest.index)
                    farthest = {index, cursor.line()};
                polygons.corners.push_back(static_cast<std::uint32_t>(index));
            }
            if (size < 3)
                cursor.fail("the face has " + std::to_string(size) + " corners, but needs 3");
            close_polygon(polygons, size);
        }
    }
    if (farthest.index >= static_cast<std::int64_t>(positions.size())) {
        throw InputError(file_name + ": line " + std::to_string(farthest.line) +
                         ": the face uses vertex " + std::to_string(farthest.index + 1) +
                         ", but there are " + std::to_string(positions.size()) + " vertices");
    }
    return make_mesh_scene(file_name, std::move(positions), std::move(polygons), source);
}

namespace {

void append_grey(std::string& text, const Occlusion& occlusion)
{
    const double visibility = 1.0 - static_cast<double>(occlusion.occlusion);
    for (int channel = 0; channel < 3; ++channel) {
        text += ' ';
        append_fixed(text, visibility, 6);
    }
}

/// The mark as the first line, which ends as the first line of `like` does.
void append_mark_line(std::string& text, std::string_view mark, std::string_view like)
{
    if (mark.empty())
        return;
    const std::string_view end = like.substr(std::min(like.find_first_of("\r\n"), like.size()));
    text.append("# ").append(mark);
    if (end.empty())
        text += '\n';
    else
        text.append(end.substr(0, end.starts_with("\r\n") ? 2 : 1));
}

std::string with_new_vertex_lines(const std::string& old, std::span<const Occlusion> occlusion,
                                  std::string_view mark)
{
    std::string text;
    text.reserve(old.size() + mark.size() + occlusion.size() * 28);
    std::size_t copied = old.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    text.append(old, 0, copied);
    append_mark_line(text, mark, old);
    copied += obj_mark_size(std::string_view(old).substr(copied));
    std::size_t vertex = 0;
    TextCursor cursor("", old, kObjRules);
    while (cursor.next_line()) {
        if (cursor.word() != "v")
            continue;
        for (int axis = 0; axis < 3; ++axis)
            cursor.word();
        text.append(old, copied, cursor.offset() - copied);
        append_grey(text, occlusion[vertex++]);
        while (!cursor.at_line_end())
            cursor.word();
        copied = cursor.offset();
        if (copied < old.size() && old[copied] == kObjRules.comment)
            text += ' ';
    }
    return text.append(old, copied);
}

}  // namespace

std::string obj_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                         std::string_view mark)
{
    if (const auto* source = dynamic_cast<const ObjSource*>(scene.asset.get()))
        return with_new_vertex_lines(source->text, occlusion, mark);
    std::string text;
    append_mark_line(text, mark, {});
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        text += 'v';
        for (int axis = 0; axis < 3; ++axis) {
            text += ' ';
            append_shortest(text, scene.positions[v][axis]);
        }
        append_grey(text, occlusion[v]);
        text += '\n';
    }
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        text += 'f';
        for (const std::uint32_t corner : corners) {
            text += ' ';
            append_integer(text, std::int64_t{corner} + 1);
        }
        text += '\n';
    });
    return text;
}

}  // namespace surfelao
