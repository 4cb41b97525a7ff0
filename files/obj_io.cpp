#include "files/obj_io.h"

#include "files/obj_file.h"
#include "surfels/errors.h"

#include <algorithm>

namespace surfelao {
namespace {

/// What the corners of faces name by number: vertices, and normals.
struct Numbered {
    std::string_view one;
    std::string_view many;
    std::int64_t farthest = -1;  ///< the largest index in use: it may come later in the file
    std::uint64_t farthest_line = 0;
};

glm::dvec3 read_vertex(TextCursor& cursor, ObjSource& source)
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
    source.has_colors = source.has_colors || more > 2;
    return position;
}

glm::vec3 read_normal(TextCursor& cursor)
{
    glm::vec3 normal;
    for (int axis = 0; axis < 3; ++axis)
        normal[axis] = static_cast<float>(cursor.any_number("a coordinate of the normal"));
    return normal;
}

[[noreturn]] void refuse_index(const TextCursor& cursor, std::int64_t number, std::size_t count,
                               const Numbered& numbered)
{
    const std::string many(numbered.many);
    const std::string use =
        "the face uses " + std::string(numbered.one) + " " + std::to_string(number) + ", but ";
    if (number == 0)
        cursor.fail(use + many + " are counted from 1");
    cursor.fail(use + "there are " + std::to_string(count) + " " + many + " so far");
}

/// The index, counted from 0, of the one that this word names when there are `count` so far.
std::uint32_t read_index(const TextCursor& cursor, std::string_view word, std::size_t count,
                         Numbered& numbered)
{
    const std::int64_t number = cursor.integer_of(word);
    const std::int64_t index = number > 0 ? number - 1 : static_cast<std::int64_t>(count) + number;
    if (number == 0 || index < 0)
        refuse_index(cursor, number, count, numbered);
    if (index > numbered.farthest) {
        numbered.farthest = index;
        numbered.farthest_line = cursor.line();
    }
    return static_cast<std::uint32_t>(index);  // one beyond 32 bits is refused as the farthest
}

void check_farthest(const std::string& file_name, const Numbered& numbered, std::size_t count)
{
    if (numbered.farthest < static_cast<std::int64_t>(count))
        return;
    throw InputError(file_name + ": line " + std::to_string(numbered.farthest_line) +
                     ": the face uses " + std::string(numbered.one) + " " +
                     std::to_string(numbered.farthest + 1) + ", but there are " +
                     std::to_string(count) + " " + std::string(numbered.many));
}

class Reader {
public:
    void read_face(TextCursor& cursor)
    {
        std::uint32_t size = 0;
        for (; !cursor.at_line_end(); ++size)
            read_corner(cursor, cursor.word());
        if (size < 3)
            cursor.fail("the face has " + std::to_string(size) + " corners, but needs 3");
        close_polygon(polygons, size);
    }

    void finish(const std::string& file_name)
    {
        check_farthest(file_name, vertices_, positions.size());
        check_farthest(file_name, normals_, normals.values.size());
        if (normals.corners.empty())  // nobody uses any
            normals.values = {};
    }

    std::vector<glm::dvec3> positions;
    PolygonNormals normals;
    Polygons polygons;

private:
    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`
    void read_corner(const TextCursor& cursor, std::string_view word)
    {
        const std::size_t slash = word.find('/');
        const std::uint32_t vertex =
            read_index(cursor, word.substr(0, slash), positions.size(), vertices_);
        std::uint32_t normal = CornerNormals::kNone;
        if (slash != std::string_view::npos) {
            const std::string_view rest = word.substr(slash + 1);
            const std::size_t second = rest.find('/');
            const std::string_view texture = rest.substr(0, second);
            if (!texture.empty())
                cursor.integer_of(texture);
            if (second != std::string_view::npos && second + 1 < rest.size()) {
                normal =
                    read_index(cursor, rest.substr(second + 1), normals.values.size(), normals_);
                if (normals.corners.empty())  // the first: those before it have none
                    normals.corners.assign(polygons.corners.size(), CornerNormals::kNone);
            }
        }
        polygons.corners.push_back(vertex);
        if (!normals.corners.empty() || normal != CornerNormals::kNone)
            normals.corners.push_back(normal);
    }

    Numbered vertices_{"vertex", "vertices"};
    Numbered normals_{"normal", "normals"};
};

}  // namespace

Scene read_obj(const std::string& file_name, std::string contents)
{
    const auto source = std::make_shared<ObjSource>();
    source->folder = std::filesystem::absolute(file_name).parent_path();
    source->text = std::move(contents);
    Reader reader;
    TextCursor cursor(file_name, source->text, kObjRules);
    while (cursor.next_line()) {
        const std::string_view statement = cursor.word();
        if (statement == "v") {
            reader.positions.push_back(read_vertex(cursor, *source));
        } else if (statement == "f" || statement == "fo") {
            reader.read_face(cursor);
        } else if (statement == "vn") {
            reader.normals.values.push_back(read_normal(cursor));
        }
    }
    reader.finish(file_name);
    source->vertex_count = reader.positions.size();
    return make_mesh_scene(file_name, std::move(reader.positions), std::move(reader.polygons),
                           source, std::move(reader.normals));
}

}  // namespace surfelao
