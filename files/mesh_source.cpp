#include "files/mesh_source.h"

#include "files/triangulate.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <sstream>

namespace surfelao {
namespace {

constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void refuse(std::string_view file_name, const std::string& fault)
{
    throw InputError(std::string(file_name) + ": " + fault);
}

bool has_place(const glm::dvec3& position)
{
    // false for what is no number too
    return std::abs(position.x) <= kLargestCoordinate &&
           std::abs(position.y) <= kLargestCoordinate && std::abs(position.z) <= kLargestCoordinate;
}

[[noreturn]] void refuse_vertex(std::string_view file_name, std::uint32_t vertex,
                                const glm::dvec3& position, std::size_t face)
{
    double value = position.x;
    for (int axis = 1; axis < 3 && std::abs(value) <= kLargestCoordinate; ++axis)
        value = position[axis];
    std::ostringstream fault;
    fault << "vertex " << vertex << " has the coordinate " << value;
    if (std::isfinite(value))
        fault << ", but the largest allowed is " << kLargestCoordinate;
    else
        fault << ", which is not finite";
    fault << "; face " << face << " uses it";
    refuse(file_name, fault.str());
}

void check_corners(std::string_view file_name, const std::vector<glm::dvec3>& positions,
                   const Polygons& polygons)
{
    std::atomic<bool> are_right{true};
    for_all(polygons.corners.size(), [&](std::size_t i) {
        const std::uint32_t corner = polygons.corners[i];
        if (corner >= positions.size() || !has_place(positions[corner]))
            are_right.store(false, std::memory_order_relaxed);
    });
    if (are_right)
        return;
    std::size_t first = 0;
    for (std::size_t face = 0; face < polygons.count(); ++face) {
        const std::size_t size = polygons.sizes.empty() ? 3 : polygons.sizes[face];
        for (const std::uint32_t corner : std::span(&polygons.corners[first], size)) {
            if (corner >= positions.size())
                refuse(file_name, "face " + std::to_string(face) + " uses vertex " +
                                      std::to_string(corner) + ", but there are " +
                                      std::to_string(positions.size()) + " vertices");
            if (!has_place(positions[corner]))
                refuse_vertex(file_name, corner, positions[corner], face);
        }
        first += size;
    }
}

/// Gives those without a place one that leaves the box of the scene as it is; returns how many.
std::uint64_t place_unused(std::vector<glm::dvec3>& positions, std::uint32_t used)
{
    std::uint64_t count = 0;
    for (glm::dvec3& position : positions) {
        if (has_place(position))
            continue;
        position = positions[used];
        ++count;
    }
    return count;
}

/// Makes normals zero that are not finite; returns how many are zero then.
std::uint64_t clear_odd_normals(std::vector<glm::vec3>& normals)
{
    std::uint64_t count = 0;
    for (glm::vec3& normal : normals) {
        if (!std::isfinite(normal.x) || !std::isfinite(normal.y) || !std::isfinite(normal.z))
            normal = glm::vec3(0.0f);
        count += normal == glm::vec3(0.0f) ? 1 : 0;
    }
    return count;
}

/// Where the only triangle of a polygon of three corners lies.
constexpr glm::uvec3 kWhole(0, 1, 2);

/// Numbers at the corners of polygons that become those of the corners of triangles.
struct CornerNumbers {
    const std::vector<std::uint32_t>* polygons;
    std::vector<glm::uvec3>* triangles;

    /// Appends the triangles that lie at these places of the polygon whose corners begin at
    /// `first`.
    void append(std::size_t first, std::span<const glm::uvec3> places) const
    {
        const std::uint32_t* corners = polygons->data() + first;
        for (const glm::uvec3& place : places)
            triangles->emplace_back(corners[place.x], corners[place.y], corners[place.z]);
    }

    /// All of them, where every polygon is a triangle.
    void copy() const
    {
        triangles->resize(polygons->size() / 3);
        for_all(triangles->size(), [&](std::size_t t) {
            const std::uint32_t* corners = polygons->data() + 3 * t;
            (*triangles)[t] = {corners[0], corners[1], corners[2]};
        });
    }
};

/// Leaves no numbers that are those of the vertices.
template <class Value>
void drop_own_numbers(PolygonValues<Value>& given, std::size_t vertices, const Polygons& polygons)
{
    if (given.values.size() == vertices && given.corners == polygons.corners)
        given.corners = {};
}

}  // namespace

void add_note(std::vector<std::string>& notes, std::uint64_t count, const std::string& noun,
              const std::string& rest)
{
    if (count > 0)
        notes.push_back(count_text(count, noun) + ' ' + rest);
}

void close_polygon(Polygons& polygons, std::uint32_t size)
{
    if (size < 3) {
        polygons.corners.resize(polygons.corners.size() - size);
        ++polygons.small_count;
        return;
    }
    if (size == 3 && polygons.sizes.empty())
        return;
    if (polygons.sizes.empty())  // the first that is no triangle
        polygons.sizes.assign((polygons.corners.size() - size) / 3, 3);
    polygons.sizes.push_back(size);
}

void append(Polygons& polygons, const Polygons& more)
{
    std::vector<std::uint32_t>& sizes = polygons.sizes;
    if (!sizes.empty() || !more.sizes.empty()) {
        sizes.resize(polygons.count(), 3);
        if (more.sizes.empty())
            sizes.resize(sizes.size() + more.count(), 3);
        sizes.insert(sizes.end(), more.sizes.begin(), more.sizes.end());
    }
    polygons.corners.insert(polygons.corners.end(), more.corners.begin(), more.corners.end());
    polygons.small_count += more.small_count;
}

Scene make_mesh_scene(std::string_view file_name, std::vector<glm::dvec3> positions,
                      Polygons polygons, std::shared_ptr<MeshSource> source, PolygonCorners given)
{
    const std::size_t polygon_count = polygons.count();
    if (polygon_count == 0)
        refuse(file_name,
               polygons.small_count > 0 ? "has no faces of three corners or more" : "has no faces");
    const std::size_t triangle_count = polygons.corners.size() - 2 * polygon_count;
    if (std::max({positions.size(), given.normals.values.size(), given.uvs.values.size(),
                  triangle_count}) > kMost)
        refuse(file_name, "has more than " + std::to_string(kMost) +
                              " vertices, normals, texture coordinates or triangles");
    check_corners(file_name, positions, polygons);
    Scene scene;
    add_note(scene.notes, polygons.small_count, "face", "of fewer than three corners passed over");
    add_note(scene.notes, place_unused(positions, polygons.corners.front()), "vertex|vertices",
             "without a finite place, but in no face, passed over");
    drop_own_numbers(given.normals, positions.size(), polygons);
    drop_own_numbers(given.uvs, positions.size(), polygons);

    if (!given.uvs.values.empty())
        scene.uvs.emplace_back();
    std::vector<CornerNumbers> streams{{&polygons.corners, &scene.triangles}};
    if (!given.normals.corners.empty())
        streams.push_back({&given.normals.corners, &scene.normals.corners});
    if (!given.uvs.corners.empty())
        streams.push_back({&given.uvs.corners, &scene.uvs.front().corners});
    for (const CornerNumbers& numbers : streams) {
        if (polygons.sizes.empty())
            numbers.copy();
        else
            numbers.triangles->reserve(triangle_count);
    }
    std::vector<glm::uvec3> cut;
    std::size_t first = 0;
    for (const std::uint32_t size : polygons.sizes) {
        std::span<const glm::uvec3> places(&kWhole, 1);
        if (size > 3) {
            cut.clear();
            triangulate(positions, {&polygons.corners[first], size}, cut);
            places = cut;
        }
        for (const CornerNumbers& numbers : streams)
            numbers.append(first, places);
        first += size;
    }
    scene.normals.values = std::move(given.normals.values);
    if (!scene.uvs.empty())
        scene.uvs.front().values = std::move(given.uvs.values);
    scene.positions = std::move(positions);
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    scene.parts = {part};
    if (!polygons.sizes.empty())
        source->polygons = std::move(polygons);
    scene.asset = std::move(source);
    return scene;
}

Scene make_scene_of(std::string_view file_name, std::vector<glm::dvec3> positions,
                    Polygons polygons, std::shared_ptr<MeshSource> source, PolygonCorners given)
{
    if (polygons.count() > 0 || polygons.small_count > 0 || positions.empty())
        return make_mesh_scene(file_name, std::move(positions), std::move(polygons),
                               std::move(source), std::move(given));
    if (positions.size() > kMostElements)
        refuse(file_name, "has more than " + std::to_string(kMostElements) + " points");
    Scene scene;
    const auto first = std::ranges::find_if(positions, has_place);
    if (first == positions.end())
        refuse(file_name, "has no point with finite coordinates up to 1e100");
    const glm::dvec3 stand_in = *first;
    for (std::size_t point = 0; point < positions.size(); ++point) {
        if (has_place(positions[point]))
            continue;
        positions[point] = stand_in;
        scene.placeless.push_back(static_cast<std::uint32_t>(point));
    }
    add_note(scene.notes, scene.placeless.size(), "point",
             "without a finite place: kept in the file, with occlusion 0");
    if (given.normals.values.size() == positions.size()) {
        scene.normals.values = std::move(given.normals.values);
        const std::uint64_t lost = clear_odd_normals(scene.normals.values);
        if (lost == positions.size())
            scene.normals.values.clear();
        else
            add_note(scene.notes, lost, "point", "without a normal, although others have one");
    }
    scene.positions = std::move(positions);
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    scene.parts = {part};
    scene.asset = std::move(source);
    return scene;
}

std::optional<glm::dvec3> as_viewpoint(const glm::dvec3& place)
{
    return has_place(place) && place != glm::dvec3(0.0) ? std::optional(place) : std::nullopt;
}

const Polygons* source_polygons(const Scene& scene)
{
    const MeshSource* source = dynamic_cast<const MeshSource*>(scene.asset.get());
    return source && !source->polygons.sizes.empty() ? &source->polygons : nullptr;
}

std::size_t longest_face(const Scene& scene)
{
    const Polygons* polygons = source_polygons(scene);
    return polygons ? *std::ranges::max_element(polygons->sizes) : 3;
}

std::size_t face_count(const Scene& scene)
{
    const Polygons* polygons = source_polygons(scene);
    return polygons ? polygons->count() : scene.triangles.size();
}

}  // namespace surfelao
