#include "files/obj_io.h"

#include "files/obj_file.h"
#include "files/own_colors.h"
#include "files/row_ranges.h"
#include "surfels/errors.h"
#include "surfels/labels.h"

#include <array>
#include <limits>
#include <utility>

namespace surfelao {
namespace {

/// Thrown where a range of lines names things by counting back to those of lines before it.
struct CountsBack {};

glm::dvec3 read_vertex(TextCursor& cursor, bool& has_colors)
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
    has_colors = has_colors || more > 2;
    return position;
}

glm::vec3 read_normal(TextCursor& cursor)
{
    glm::vec3 normal;
    for (int axis = 0; axis < 3; ++axis)
        normal[axis] = static_cast<float>(cursor.any_number("a coordinate of the normal"));
    return normal;
}

/// How many vertices, normals or texture coordinates there are so far.
struct SoFar {
    std::size_t count = 0;
    bool is_known = true;  ///< nothing stands before the range of lines
};

/// What `number` names, counted from 0; negative: nothing.
std::int64_t index_of(std::int64_t number, const SoFar& so_far)
{
    if (number == 0)
        return -1;
    if (number < 0 && !so_far.is_known)
        throw CountsBack();
    return number > 0 ? number - 1 : static_cast<std::int64_t>(so_far.count) + number;
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
    void read(const TextCursor& cursor, std::size_t corner, std::string_view word, bool is_first)
    {
        const std::int64_t index =
            index_of(cursor.integer_of(word), {this->values.size(), is_first});
        const bool is_one = index >= 0 && index < kNoValue;
        lost += is_one ? 0 : 1;
        this->set(corner, is_one ? static_cast<std::uint32_t>(index) : kNoValue);
    }

    /// Those of the next lines. corners: how many there are before.
    void append(const NamedValues& more, std::size_t corner_count)
    {
        this->values.insert(this->values.end(), more.values.begin(), more.values.end());
        if (!more.corners.empty()) {
            this->corners.resize(corner_count, kNoValue);
            this->corners.insert(this->corners.end(), more.corners.begin(), more.corners.end());
        }
        lost += more.lost;
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

/// `o NAME`, `usemtl NAME`, `g NAME NAME ...`
struct NameLine {
    LabelKind kind = LabelKind::object;
    std::vector<std::string_view> names;
    std::size_t triangles = 0;  ///< before it
};

/// Which faces have which names. A name holds until the next of its kind.
class FaceNames {
public:
    void set(const NameLine& line)
    {
        Current& current = currents_[static_cast<std::size_t>(line.kind)];
        end(current, line.kind, line.triangles);
        current.names = line.names;
    }
    std::vector<Label> finish(std::size_t triangles)
    {
        for (const LabelKind kind : {LabelKind::object, LabelKind::group, LabelKind::material})
            end(currents_[static_cast<std::size_t>(kind)], kind, triangles);
        return maker_.finish();
    }

private:
    struct Current {
        std::vector<std::string_view> names;
        std::size_t first = 0;
    };
    void end(Current& current, LabelKind kind, std::size_t triangles)
    {
        for (const std::string_view name : current.names)
            maker_.add(kind, name, static_cast<std::uint32_t>(current.first),
                       static_cast<std::uint32_t>(triangles - current.first));
        current.first = triangles;
    }

    std::array<Current, 5> currents_;  ///< by kind
    LabelMaker maker_;
};

/// What lines say.
class Reader {
public:
    /// is_first: no lines stand before those that are read.
    explicit Reader(bool is_first) : is_first_(is_first) {}

    void read(TextCursor& cursor)
    {
        while (cursor.next_line())
            read_line(cursor);
    }

    /// Appends what the next lines say.
    void append(const Reader& more)
    {
        for (NameLine line : more.names) {
            line.triangles += triangle_count();
            names.push_back(std::move(line));
        }
        normals.append(more.normals, polygons.corners.size());
        uvs.append(more.uvs, polygons.corners.size());
        positions.insert(positions.end(), more.positions.begin(), more.positions.end());
        surfelao::append(polygons, more.polygons);
        normals.close(polygons);
        uvs.close(polygons);
        libraries.insert(libraries.end(), more.libraries.begin(), more.libraries.end());
        has_colors = has_colors || more.has_colors;
        if (more.farthest_ > farthest_) {
            farthest_ = more.farthest_;
            farthest_line_ = more.farthest_line_;
        }
    }

    /// That the faces so far are cut into.
    [[nodiscard]] std::size_t triangle_count() const
    {
        return polygons.corners.size() - 2 * polygons.count();
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
    std::vector<NameLine> names;
    std::vector<std::string> libraries;  ///< what stands behind each `mtllib`
    bool has_colors = false;             ///< at some vertex

private:
    void read_line(TextCursor& cursor)
    {
        const std::string_view statement = cursor.word();
        if (statement == "v") {
            positions.push_back(read_vertex(cursor, has_colors));
        } else if (statement == "f" || statement == "fo") {
            read_face(cursor);
        } else if (statement == "vn") {
            normals.values.push_back(read_normal(cursor));
        } else if (statement == "vt") {
            uvs.values.push_back(read_uv(cursor));
        } else if (statement == "mtllib") {
            libraries.emplace_back(cursor.rest_of_line());
        } else if (statement == "g") {
            NameLine& line = names.emplace_back(NameLine{LabelKind::group, {}, triangle_count()});
            while (!cursor.at_line_end())
                line.names.push_back(cursor.word());
        } else if (statement == "o" || statement == "usemtl") {
            names.push_back({statement == "o" ? LabelKind::object : LabelKind::material,
                             {cursor.rest_of_line()},
                             triangle_count()});
        }
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
            uvs.read(cursor, corner, uv, is_first_);
        if (second != std::string_view::npos && second + 1 < rest.size())
            normals.read(cursor, corner, rest.substr(second + 1), is_first_);
    }

    std::uint32_t read_vertex_index(const TextCursor& cursor, std::string_view word)
    {
        const std::int64_t number = cursor.integer_of(word);
        const std::int64_t index = index_of(number, {positions.size(), is_first_});
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

    bool is_first_;
    std::int64_t farthest_ = -1;  ///< the largest vertex in use
    std::uint64_t farthest_line_ = 0;
};

/// All lines, by all threads; where they count back, by one.
Reader read_lines(const std::string& file_name, std::string_view text)
{
    const TextCursor start(file_name, text, kObjRules);
    const std::vector<table::RowRange> ranges = table::line_ranges(start);
    std::vector<Reader> readers;
    for (std::size_t i = 0; i < ranges.size(); ++i)
        readers.emplace_back(i == 0);
    try {
        table::for_each_in_order(ranges.size(), [&](std::size_t i) {
            const std::size_t end = i + 1 < ranges.size() ? ranges[i + 1].offset : text.size();
            TextCursor lines = start.part(ranges[i].offset, end, ranges[i].line);
            readers[i].read(lines);
        });
    } catch (const CountsBack&) {
        Reader reader(true);
        TextCursor lines = start;
        reader.read(lines);
        return reader;
    }
    for (std::size_t i = 1; i < readers.size(); ++i)
        readers.front().append(std::exchange(readers[i], Reader(false)));
    return std::move(readers.front());
}

}  // namespace

Scene read_obj(const std::string& file_name, std::string contents)
{
    const auto source = std::make_shared<ObjSource>();
    source->folder = std::filesystem::absolute(file_name).parent_path();
    source->text = std::move(contents);
    Reader reader = read_lines(file_name, source->text);
    source->has_colors = reader.has_colors;
    source->libraries = std::move(reader.libraries);
    FaceNames names;
    for (const NameLine& line : reader.names)
        names.set(line);
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
