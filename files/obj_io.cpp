#include "files/obj_io.h"

#include "files/obj_file.h"
#include "surfels/errors.h"

#include <algorithm>

namespace surfelao {
namespace {

glm::dvec3 read_vertex(TextCursor& cursor, ObjSource& source)
{
    glm::dvec3 position;
    for (int axis = 0; axis < 3; ++axis)
        position[axis] = cursor.any_number("a coordinate of the vertex");
    int more = 0;
    for (; !cursor.at_line_end(); ++more)
        cursor.any_number("a number");
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

/// What `number` names when there are `count` so far, counted from 0; negative: nothing.
std::int64_t index_of(std::int64_t number, std::size_t count)
{
    if (number == 0)
        return -1;
    return number > 0 ? number - 1 : static_cast<std::int64_t>(count) + number;
}

class Reader {
public:
    void read_face(TextCursor& cursor)
    {
        std::uint32_t size = 0;
        for (; !cursor.at_line_end(); ++size)
            read_corner(cursor, cursor.word());
        if (size < 3 && cursor.remaining() == 0)
            cursor.fail("the file ends within a face of " + std::to_string(size) + " corners");
        close_polygon(polygons, size);
        if (!normals.corners.empty())
            normals.corners.resize(polygons.corners.size());
    }

    /// Faces may use vertices and normals that come later: what there is is known at the end.
    /// Returns the corners that name a normal that there is not.
    std::uint64_t finish(const std::string& file_name)
    {
        if (farthest_ >= static_cast<std::int64_t>(positions.size()))
            throw InputError(file_name + ": line " + std::to_string(farthest_line_) +
                             ": the face uses vertex " + std::to_string(farthest_ + 1) +
                             ", but there are " + std::to_string(positions.size()) + " vertices");
        for (std::uint32_t& normal : normals.corners) {
            if (normal < normals.values.size() || normal == CornerNormals::kNone)
                continue;
            normal = CornerNormals::kNone;
            ++lost_normals_;
        }
        if (normals.corners.empty() || normals.values.empty())  // nobody uses any
            normals = {};
        return lost_normals_;
    }

    std::vector<glm::dvec3> positions;
    PolygonNormals normals;
    Polygons polygons;

private:
    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`
    void read_corner(const TextCursor& cursor, std::string_view word)
    {
        const std::size_t slash = word.find('/');
        const std::uint32_t vertex = read_vertex_index(cursor, word.substr(0, slash));
        std::uint32_t normal = CornerNormals::kNone;
        if (slash != std::string_view::npos) {
            const std::string_view rest = word.substr(slash + 1);
            const std::size_t second = rest.find('/');
            const std::string_view texture = rest.substr(0, second);
            if (!texture.empty())
                cursor.integer_of(texture);
            if (second != std::string_view::npos && second + 1 < rest.size()) {
                normal = read_normal_index(cursor, rest.substr(second + 1));
                if (normals.corners.empty())  // the first: those before it have none
                    normals.corners.assign(polygons.corners.size(), CornerNormals::kNone);
            }
        }
        polygons.corners.push_back(vertex);
        if (!normals.corners.empty() || normal != CornerNormals::kNone)
            normals.corners.push_back(normal);
    }

    std::uint32_t read_vertex_index(const TextCursor& cursor, std::string_view word)
    {
        const std::int64_t number = cursor.integer_of(word);
        const std::int64_t index = index_of(number, positions.size());
        if (index < 0)
            cursor.fail("the face uses vertex " + std::to_string(number) + ", but " +
                        (number == 0 ? "vertices are counted from 1"
                                     : "there are " + std::to_string(positions.size()) +
                                           " vertices so far"));
        if (index > farthest_) {
            farthest_ = index;
            farthest_line_ = cursor.line();
        }
        return static_cast<std::uint32_t>(index);  // one beyond 32 bits is refused as the farthest
    }

    std::uint32_t read_normal_index(const TextCursor& cursor, std::string_view word)
    {
        const std::int64_t index = index_of(cursor.integer_of(word), normals.values.size());
        if (index >= 0 && index < CornerNormals::kNone)
            return static_cast<std::uint32_t>(index);
        ++lost_normals_;
        return CornerNormals::kNone;
    }

    std::int64_t farthest_ = -1;  ///< the largest vertex in use
    std::uint64_t farthest_line_ = 0;
    std::uint64_t lost_normals_ = 0;
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
    const std::uint64_t lost_normals = reader.finish(file_name);
    source->vertex_count = reader.positions.size();
    Scene scene = make_mesh_scene(file_name, std::move(reader.positions),
                                  std::move(reader.polygons), source, std::move(reader.normals));
    add_note(scene.notes, lost_normals, "corner",
             "of faces with a normal that the file does not have: taken as without");
    return scene;
}

}  // namespace surfelao
