#include "files/mesh_source.h"

#include "files/triangulate.h"
#include "surfels/errors.h"

#include <algorithm>
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

void check_positions(std::string_view file_name, const std::vector<glm::dvec3>& positions)
{
    for (std::size_t v = 0; v < positions.size(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            const double value = positions[v][axis];
            if (std::abs(value) <= kLargestCoordinate)
                continue;
            std::ostringstream fault;
            fault << "vertex " << v << " has the coordinate " << value;
            if (std::isfinite(value))
                fault << ", but the largest allowed is " << kLargestCoordinate;
            else
                fault << ", which is not finite";
            refuse(file_name, fault.str());
        }
    }
}

/// Where the only triangle of a polygon of three corners lies.
constexpr glm::uvec3 kWhole(0, 1, 2);

/// Appends the triangles that lie at these places of the corners.
void append_triangles(std::span<const std::uint32_t> corners, std::span<const glm::uvec3> places,
                      std::vector<glm::uvec3>& triangles)
{
    for (const glm::uvec3& place : places)
        triangles.emplace_back(corners[place.x], corners[place.y], corners[place.z]);
}

}  // namespace

void close_polygon(Polygons& polygons, std::uint32_t size)
{
    if (size == 3 && polygons.sizes.empty())
        return;
    if (polygons.sizes.empty())  // the first that is no triangle
        polygons.sizes.assign((polygons.corners.size() - size) / 3, 3);
    polygons.sizes.push_back(size);
}

Scene make_mesh_scene(std::string_view file_name, std::vector<glm::dvec3> positions,
                      Polygons polygons, std::shared_ptr<MeshSource> source, PolygonNormals normals)
{
    const std::size_t polygon_count = polygons.count();
    if (polygon_count == 0)
        refuse(file_name, "has no faces");
    const std::size_t triangle_count = polygons.corners.size() - 2 * polygon_count;
    if (std::max({positions.size(), normals.values.size(), triangle_count}) > kMost)
        refuse(file_name,
               "has more than " + std::to_string(kMost) + " vertices, normals or triangles");
    check_positions(file_name, positions);
    if (normals.values.size() == positions.size() && normals.corners == polygons.corners)
        normals.corners = {};

    Scene scene;
    scene.triangles.reserve(triangle_count);
    if (!normals.corners.empty())
        scene.normals.corners.reserve(triangle_count);
    std::vector<glm::uvec3> cut;
    std::size_t first = 0;
    for (std::size_t face = 0; face < polygon_count; ++face) {
        const std::size_t size = polygons.sizes.empty() ? 3 : polygons.sizes[face];
        const std::span<const std::uint32_t> corners(&polygons.corners[first], size);
        for (const std::uint32_t corner : corners) {
            if (corner >= positions.size())
                refuse(file_name, "face " + std::to_string(face) + " uses vertex " +
                                      std::to_string(corner) + ", but there are " +
                                      std::to_string(positions.size()) + " vertices");
        }
        std::span<const glm::uvec3> places(&kWhole, 1);
        if (size == 3) {
            scene.triangles.emplace_back(corners[0], corners[1], corners[2]);
        } else {
            cut.clear();
            triangulate(positions, corners, cut);
            places = cut;
            append_triangles(corners, places, scene.triangles);
        }
        if (!normals.corners.empty())
            append_triangles({&normals.corners[first], size}, places, scene.normals.corners);
        first += size;
    }
    scene.normals.values = std::move(normals.values);
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

const Polygons* source_polygons(const Scene& scene)
{
    const MeshSource* source = dynamic_cast<const MeshSource*>(scene.asset.get());
    return source && !source->polygons.sizes.empty() ? &source->polygons : nullptr;
}

std::size_t face_count(const Scene& scene)
{
    const Polygons* polygons = source_polygons(scene);
    return polygons ? polygons->count() : scene.triangles.size();
}

}  // namespace surfelao
