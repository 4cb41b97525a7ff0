#include "files/obj_io.h"

#include "files/obj_file.h"
#include "files/own_colors.h"
#include "surfels/errors.h"
#include "surfels/labels.h"

#include <limits>

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

/// Texture coordinates as UvSet has them: in the file v runs up, and is 0 where it is missing.
glm::dvec2 read_uv(TextCursor& cursor)
{
    const auto number = [](std::string_view word) {
        return number_in(word).value_or(std::numeric_limits<double>::quiet_NaN());
    };
    const double u = number(cursor.word());
    return {u, 1.0 - (cursor.at_line_end() ? 0.0 : number(cursor.word()))};
}

/// Values that corners of faces name by numbers.
template <class Value>
struct NamedValues : PolygonValues<Value> {
    std::uint64_t lost = 0;  ///< corners that name one that there is not

    /// Of the corner of this number, which names its value by `word`.
    void read(const TextCursor& cursor, std::size_t corner, std::string_view word)
    {
        const std::int64_t index = index_of(cursor.integer_of(word), this->values.size());
        const bool is_one = index >= 0 && index < kNoValue;
        lost += is_one ? 0 : 1;
        this->set(corner, is_one ? static_cast<std::uint32_t>(index) : kNoValue);
    }

    /// After the last value.
    void finish()
    {
        for (std::uint32_t& value : this->corners) {
            if (value < this->values.size() || value == kNoValue)
                continue;
            value = kNoValue;
            ++lost;
        }
        if (this->corners.empty() || this->values.empty())  // nobody uses any
            static_cast<PolygonValues<Value>&>(*this) = {};
    }
};

/// Which faces have which names. A name holds until the next of its kind.
class FaceNames {
public:
    /// `o NAME`, `usemtl NAME`: all that stands on the line.
    void set(LabelKind kind, std::string_view name, std::size_t triangles)
    {
        end(of(kind), kind, triangles);
        of(kind).names = {name};
    }
    /// `g NAME NAME ...`
    void set_groups(TextCursor& cursor, std::size_t triangles)
    {
        end(groups_, LabelKind::group, triangles);
        groups_.names.clear();
        while (!cursor.at_line_end())
            groups_.names.push_back(cursor.word());
    }
    std::vector<Label> finish(std::size_t triangles)
    {
        end(object_, LabelKind::object, triangles);
        end(groups_, LabelKind::group, triangles);
        end(material_, LabelKind::material, triangles);
        return maker_.finish();
    }

private:
    struct Current {
        std::vector<std::string_view> names;
        std::size_t first = 0;
    };
    Current& of(LabelKind kind) { return kind == LabelKind::object ? object_ : material_; }
    void end(Current& current, LabelKind kind, std::size_t triangles)
    {
        for (const std::string_view name : current.names)
            maker_.add(kind, name, static_cast<std::uint32_t>(current.first),
                       static_cast<std::uint32_t>(triangles - current.first));
        current.first = triangles;
    }

    Current object_, groups_, material_;
    LabelMaker maker_;
};

class Reader {
public:
    /// That the faces so far are cut into.
    [[nodiscard]] std::size_t triangle_count() const
    {
        return polygons.corners.size() - 2 * polygons.count();
    }

    void read_face(TextCursor& cursor)
    {
        std::uint32_t size = 0;
        for (; !cursor.at_line_end(); ++size)
            read_corner(cursor, cursor.word());
        if (size < 3 && cursor.remaining() == 0)
            cursor.fail("the file ends within a face of " + std::to_string(size) + " corners");
        close_polygon(polygons, size);
        normals.close(polygons);
        uvs.close(polygons);
    }

    /// Faces may use what comes later: what there is is known at the end.
    void finish(const std::string& file_name)
    {
        if (farthest_ >= static_cast<std::int64_t>(positions.size()))
            throw InputError(file_name + ": line " + std::to_string(farthest_line_) +
                             ": the face uses vertex " + std::to_string(farthest_ + 1) +
                             ", but there are " + std::to_string(positions.size()) + " vertices");
        if (polygons.count() > 0)  // a cloud's are those of its points
            normals.finish();
        uvs.finish();
    }

    std::vector<glm::dvec3> positions;
    NamedValues<glm::vec3> normals;
    NamedValues<glm::dvec2> uvs;
    Polygons polygons;

private:
    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`
    void read_corner(const TextCursor& cursor, std::string_view word)
    {
        const std::size_t slash = word.find('/');
        const std::size_t corner = polygons.corners.size();
        polygons.corners.push_back(read_vertex_index(cursor, word.substr(0, slash)));
        if (slash == std::string_view::npos)
            return;
        const std::string_view rest = word.substr(slash + 1);
        const std::size_t second = rest.find('/');
        if (const std::string_view uv = rest.substr(0, second); !uv.empty())
            uvs.read(cursor, corner, uv);
        if (second != std::string_view::npos && second + 1 < rest.size())
            normals.read(cursor, corner, rest.substr(second + 1));
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

    std::int64_t farthest_ = -1;  ///< the largest vertex in use
    std::uint64_t farthest_line_ = 0;
};

}  // namespace

Scene read_obj(const std::string& file_name, std::string contents)
{
    const auto source = std::make_shared<ObjSource>();
    source->folder = std::filesystem::absolute(file_name).parent_path();
    source->text = std::move(contents);
    Reader reader;
    FaceNames names;
    TextCursor cursor(file_name, source->text, kObjRules);
    while (cursor.next_line()) {
        const std::string_view statement = cursor.word();
        if (statement == "v") {
            reader.positions.push_back(read_vertex(cursor, *source));
        } else if (statement == "f" || statement == "fo") {
            reader.read_face(cursor);
        } else if (statement == "vn") {
            reader.normals.values.push_back(read_normal(cursor));
        } else if (statement == "vt") {
            reader.uvs.values.push_back(read_uv(cursor));
        } else if (statement == "mtllib") {
            source->libraries.emplace_back(cursor.rest_of_line());
        } else if (statement == "g") {
            names.set_groups(cursor, reader.triangle_count());
        } else if (statement == "o" || statement == "usemtl") {
            names.set(statement == "o" ? LabelKind::object : LabelKind::material,
                      cursor.rest_of_line(), reader.triangle_count());
        }
    }
    reader.finish(file_name);
    const std::uint64_t lost_normals = reader.normals.lost, lost_uvs = reader.uvs.lost;
    source->vertex_count = reader.positions.size();
    const std::size_t triangles = reader.triangle_count();
    Scene scene = make_scene_of(file_name, std::move(reader.positions), std::move(reader.polygons),
                                source, {std::move(reader.normals), std::move(reader.uvs)});
    scene.labels = names.finish(triangles);  // at most as many as 32 bits count, by now
    add_note(scene.notes, lost_normals, "corner",
             "of faces with a normal that the file does not have: taken as without");
    add_note(scene.notes, lost_uvs, "corner",
             "of faces with a texture coordinate that the file does not have: taken as without");
    return scene;
}

}  // namespace surfelao
