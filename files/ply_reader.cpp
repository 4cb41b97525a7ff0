#include "files/mesh_source.h"
#include "files/ply_file.h"
#include "files/ply_io.h"
#include "surfels/errors.h"

#include <algorithm>
#include <array>

namespace surfelao {
namespace {

using namespace ply;

/// Which property of the element is the list of vertex indices.
std::size_t index_list(const std::string& file_name, const Element& element)
{
    const std::size_t list = index_list_of(element);
    if (list == element.properties.size())
        throw InputError(file_name + ": element " + surfelao::quoted(element.name) +
                         " has no list \"vertex_indices\"");
    const Property& property = element.properties[list];
    if (!property.count_type || !is_integer(property.type))
        throw InputError(file_name + ": property " + surfelao::quoted(property.name) +
                         " of element " + surfelao::quoted(element.name) +
                         " is not a list of integers");
    return list;
}

/// Of an element that has no such list: past its last.
std::size_t uv_list(const Element& element)
{
    return static_cast<std::size_t>(std::ranges::find_if(element.properties,
                                                         [](const Property& property) {
                                                             return property.name == "texcoord" &&
                                                                    property.count_type;
                                                         }) -
                                    element.properties.begin());
}

/// What rows of faces say.
struct Faces {
    Polygons polygons;
    PolygonValues<glm::dvec2> uvs;
    std::uint64_t odd_uv_lists = 0;  ///< whose numbers are not two for each corner, nor none

    /// Appends those of the rows behind.
    void append(const Faces& more)
    {
        const std::size_t corners = polygons.corners.size();
        if (!more.uvs.corners.empty()) {
            uvs.corners.resize(corners, kNoValue);
            for (const std::uint32_t value : more.uvs.corners)
                uvs.corners.push_back(value == kNoValue
                                          ? value
                                          : value + static_cast<std::uint32_t>(uvs.values.size()));
            uvs.values.insert(uvs.values.end(), more.uvs.values.begin(), more.uvs.values.end());
        }
        surfelao::append(polygons, more.polygons);
        odd_uv_lists += more.odd_uv_lists;
    }
};

template <class Data>
class Reader {
public:
    Reader(const std::string& file_name, PlySource& source)
        : file_name_(file_name),
          source_(source),
          data_(file_name, source.data(), source.header.form())
    {
        const Element* vertices = find_element(source.header, "vertex");
        if (!vertices)
            throw InputError(file_name + ": has no element \"vertex\"");
        vertex_count_ = vertices->count;
    }

    void run()
    {
        for (const Element& element : source_.header.elements) {
            check_size(element);
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face" && element.count > 0)
                read_faces(element);
            else if (element.name == "tristrips" && element.count > 0)
                read_strips(element);
            else if (element.name == "camera" && !element.properties.empty())
                read_camera(element);
            else
                skip_rows(element);
        }
        // what the faces say of their corners is more than what the vertices can
        if (!faces.uvs.values.empty()) {
            faces.uvs.close(faces.polygons);
            given.uvs = std::move(faces.uvs);
        }
    }

    std::vector<glm::dvec3> positions;
    PolygonCorners given;
    Faces faces;
    std::optional<glm::dvec3> camera;

private:
    /// Refuses a count for which the file is too short before anything of that size is reserved.
    void check_size(const Element& element) const
    {
        const std::size_t least = Data::least_bytes(element);
        // the last row of an ascii file may go without the end of its line
        if (least > 0 && element.count > (data_.remaining() + 1) / least) {
            throw InputError(file_name_ + ": the header says " + std::to_string(element.count) +
                             " of element " + surfelao::quoted(element.name) +
                             ", but the file is too short for that");
        }
    }

    void read_vertices(const Element& element)
    {
        const std::vector<Role> roles = roles_of(file_name_, element);
        source_.vertices_begin = data_.offset();
        VertexValues values = table::read_vertices(data_, element, roles);
        source_.vertices_end = data_.offset();
        positions = std::move(values.positions);
        given.normals.values = std::move(values.normals);
        given.uvs.values = std::move(values.uvs);
    }

    /// Where the first camera stood, as MeshLab and PCL write it.
    void read_camera(const Element& element)
    {
        constexpr std::string_view kPlace[] = {"view_px", "view_py", "view_pz"};
        glm::dvec3 place(std::numeric_limits<double>::quiet_NaN());
        for (std::uint64_t row = 0; row < element.count; ++row) {
            data_.begin_row(element, row);
            for (const Property& property : element.properties) {
                const auto axis = std::ranges::find(kPlace, property.name) - kPlace;
                if (row == 0 && axis < 3 && !property.count_type)
                    place[static_cast<int>(axis)] = data_.loose_number(property.type);
                else
                    skip_property(data_, property);
            }
            data_.end_row();
        }
        camera = as_viewpoint(place);
    }

    /// Calls read(p, length) for the lists p that it is asked of with is_read(p).
    template <class IsRead, class Read>
    static void read_row(Data& data, const Element& element, std::uint64_t row,
                         const IsRead& is_read, const Read& read)
    {
        data.begin_row(element, row);
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            if (is_read(p))
                read(p, read_length(data, element.properties[p]));
            else
                skip_property(data, element.properties[p]);
        }
        data.end_row();
    }

    void read_faces(const Element& element)
    {
        const std::size_t list = index_list(file_name_, element);
        index_type_ = element.properties[list].type;
        source_.faces_begin = data_.offset();
        const std::vector<RowRange> ranges = data_.ranges(element);
        std::vector<Faces> parts(ranges.size());
        for_each_range(data_, ranges, [&](Data& data, std::size_t i) {
            read_faces(data, element, list, ranges[i], parts[i]);
        });
        std::size_t corners = faces.polygons.corners.size();
        for (const Faces& part : parts)
            corners += part.polygons.corners.size();
        faces.polygons.corners.reserve(corners);
        for (Faces& part : parts) {
            faces.append(part);
            part = {};
        }
        source_.faces_end = data_.offset();
    }

    void read_faces(Data& data, const Element& element, std::size_t list, const RowRange& range,
                    Faces& found) const
    {
        const std::size_t uvs = uv_list(element);
        std::vector<glm::dvec2> row_uvs;
        for (std::uint64_t row = range.first; row < range.end; ++row) {
            const std::size_t first = found.polygons.corners.size();
            std::uint64_t uv_numbers = 0;
            read_row(
                data, element, row, [&](std::size_t p) { return p == list || p == uvs; },
                [&](std::size_t p, std::uint64_t length) {
                    if (p == list)
                        return read_face(data, length, found.polygons);
                    uv_numbers = length;
                    read_uvs(data, length, element.properties[p].type, row_uvs);
                });
            const std::size_t corners = found.polygons.corners.size() - first;
            if (uv_numbers == 2 * corners)
                add_uvs(first, row_uvs, found.uvs);
            else if (uv_numbers > 0 && corners > 0)
                ++found.odd_uv_lists;
            row_uvs.clear();
        }
    }

    static void read_uvs(Data& data, std::uint64_t length, Type type, std::vector<glm::dvec2>& uvs)
    {
        for (std::uint64_t i = 0; i < length; ++i) {
            const int axis = static_cast<int>(i % 2);
            if (axis == 0)
                uvs.emplace_back(0.0);
            uvs.back()[axis] = uv_number(data.loose_number(type), axis);
        }
    }

    /// Of the corners from `first` on.
    static void add_uvs(std::size_t first, const std::vector<glm::dvec2>& row,
                        PolygonValues<glm::dvec2>& uvs)
    {
        for (std::size_t i = 0; i < row.size(); ++i) {
            uvs.set(first + i, static_cast<std::uint32_t>(uvs.values.size()));
            uvs.values.push_back(row[i]);
        }
    }

    void read_strips(const Element& element)
    {
        const std::size_t list = index_list(file_name_, element);
        index_type_ = element.properties[list].type;
        for (std::uint64_t row = 0; row < element.count; ++row)
            read_row(
                data_, element, row, [&](std::size_t p) { return p == list; },
                [&](std::size_t, std::uint64_t length) { read_strip_list(length); });
        if (faces.polygons.corners.empty())  // no cloud, but a mesh of nothing
            ++faces.polygons.small_count;
    }

    std::uint32_t checked(const Data& data, std::int64_t index) const
    {
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) {
            data.fail("uses vertex " + std::to_string(index) + ", but there are " +
                      std::to_string(vertex_count_) + " vertices");
        }
        return static_cast<std::uint32_t>(index);
    }

    void read_face(Data& data, std::uint64_t length, Polygons& polygons) const
    {
        for (std::uint64_t i = 0; i < length; ++i)
            polygons.corners.push_back(checked(data, data.integer(index_type_)));
        close_polygon(polygons, static_cast<std::uint32_t>(length));
    }

    void read_strip_list(std::uint64_t length)
    {
        Polygons& polygons = faces.polygons;
        std::array<std::uint32_t, 3> last{};
        std::uint64_t in_strip = 0;
        for (std::uint64_t i = 0; i < length; ++i) {
            const std::int64_t index = data_.integer(index_type_);
            if (index == -1) {
                in_strip = 0;
                continue;
            }
            last = {last[1], last[2], checked(data_, index)};
            if (++in_strip < 3 || last[0] == last[1] || last[1] == last[2] || last[0] == last[2])
                continue;
            if (in_strip % 2 == 0)  // every other triangle of a strip is wound the other way
                polygons.corners.insert(polygons.corners.end(), {last[1], last[0], last[2]});
            else
                polygons.corners.insert(polygons.corners.end(), {last[0], last[1], last[2]});
            close_polygon(polygons, 3);
        }
    }

    void skip_rows(const Element& element)
    {
        if (element.properties.empty())
            return;
        for (std::uint64_t row = 0; row < element.count; ++row) {
            data_.begin_row(element, row);
            for (const Property& property : element.properties)
                skip_property(data_, property);
            data_.end_row();
        }
    }

    const std::string& file_name_;
    PlySource& source_;
    Data data_;
    std::uint64_t vertex_count_ = 0;
    Type index_type_ = Type::int32;
};

template <class Data>
Scene read_with(const std::string& file_name, std::shared_ptr<PlySource> source)
{
    Reader<Data> reader(file_name, *source);
    reader.run();
    Scene scene = make_scene_of(file_name, std::move(reader.positions),
                                std::move(reader.faces.polygons), source, std::move(reader.given));
    if (scene.triangles.empty())
        scene.viewpoint = source->header.viewpoint ? source->header.viewpoint : reader.camera;
    add_note(scene.notes, reader.faces.odd_uv_lists, "face",
             "with a list texcoord that has not two numbers for each corner: taken as without");
    for (const Element& element : source->header.elements)
        add_note(scene.notes,
                 static_cast<std::uint64_t>(
                     std::ranges::count(element.properties, true, &Property::is_second)),
                 "property|properties", "of a name that an earlier one has: passed over");
    return scene;
}

}  // namespace

Scene read_ply(const std::string& file_name, std::string contents)
{
    auto source = std::make_shared<PlySource>();
    source->folder = std::filesystem::absolute(file_name).parent_path();
    source->contents = std::move(contents);
    source->header = read_header(file_name, source->contents);
    if (source->header.format == Format::ascii)
        return read_with<AsciiData>(file_name, std::move(source));
    return read_with<BinaryData>(file_name, std::move(source));
}

}  // namespace surfelao
