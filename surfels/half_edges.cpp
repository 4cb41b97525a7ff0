#include "surfels/half_edges.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/Property.hh>

#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>
#include <vector>

namespace surfelao {
namespace {

/// Connectivity only: no normals, no colours, and no deleting, hence no status either.
struct Traits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::None);
    HalfedgeAttributes(OpenMesh::Attributes::None);
    EdgeAttributes(OpenMesh::Attributes::None);
    FaceAttributes(OpenMesh::Attributes::None);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

/// OpenMesh reports every face that it refuses on the error stream; we count them.
class QuietOpenMesh {
public:
    QuietOpenMesh() { omerr().disable(); }
    ~QuietOpenMesh() { omerr().enable(); }
    QuietOpenMesh(const QuietOpenMesh&) = delete;
    QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;
};

/// Not from edges.h: loops and fans are what OpenMesh finds while faces are added one by one.
Mesh build(const Geometry& geometry, std::uint64_t& complex_triangle_count)
{
    const std::size_t vertex_count = geometry.positions.size();
    std::vector<std::uint32_t> fan(vertex_count, 0);
    for (const glm::uvec3 triangle : geometry.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            ++fan[geometry.welded[triangle[corner]]];
    }
    Mesh mesh;
    mesh.reserve(vertex_count, geometry.triangles.size() * 3 / 2, geometry.triangles.size());
    for (std::size_t v = 0; v < vertex_count; ++v) {
        const glm::vec3 p = geometry.positions[v];
        mesh.add_vertex({p.x, p.y, p.z});
    }
    const QuietOpenMesh quiet;
    for (const glm::uvec3 triangle : geometry.triangles) {
        std::array<Mesh::VertexHandle, 3> corners;
        bool fits = true;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = geometry.welded[triangle[corner]];
            fits = fits && fan[v] <= kLargestFan;
            corners[static_cast<std::size_t>(corner)] = Mesh::VertexHandle(static_cast<int>(v));
        }
        if (!fits || !mesh.add_face(corners[0], corners[1], corners[2]).is_valid())
            ++complex_triangle_count;
    }
    return mesh;
}

/// The vertices of a triangle in half-edge meshes. A vertex of more than kLargestFan triangles is
/// several there, each of so many that follow each other: adding a face walks round its corners.
class FanParts {
public:
    explicit FanParts(const Geometry& geometry)
        : geometry_(geometry), seen_(geometry.positions.size(), 0)
    {
    }

    /// To be asked once for each triangle, in their order. `next` is the next free vertex.
    std::array<Mesh::VertexHandle, 3> corners_of(glm::uvec3 triangle, std::uint32_t& next)
    {
        std::array<Mesh::VertexHandle, 3> corners;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = geometry_.welded[triangle[k]];
            const std::uint32_t before = seen_[vertex]++;
            if (before >= kLargestFan && before % kLargestFan == 0)
                part_[vertex] = next++;
            const auto part = before < kLargestFan ? part_.end() : part_.find(vertex);
            corners[static_cast<std::size_t>(k)] =
                Mesh::VertexHandle(static_cast<int>(part == part_.end() ? vertex : part->second));
        }
        return corners;
    }

private:
    const Geometry& geometry_;
    std::vector<std::uint32_t> seen_;  ///< triangles so far, per vertex
    std::unordered_map<std::uint32_t, std::uint32_t> part_;
};

/// Adds those of the triangles that one mesh holds together, and notes who is across their sides.
/// Returns the others.
std::vector<std::uint32_t> join_in_one_mesh(
    const std::vector<std::array<Mesh::VertexHandle, 3>>& corners,
    const std::vector<std::uint32_t>& triangles, std::size_t vertex_count,
    std::vector<Neighbours>& neighbours)
{
    Mesh mesh;
    mesh.reserve(vertex_count, triangles.size() * 3 / 2, triangles.size());
    mesh.resize(vertex_count, 0, 0);
    std::vector<std::uint32_t> triangle_of_face, others;
    for (const std::uint32_t t : triangles) {
        const auto& [a, b, c] = corners[t];
        (mesh.add_face(a, b, c).is_valid() ? triangle_of_face : others).push_back(t);
    }
    for (const Mesh::FaceHandle face : mesh.faces()) {
        const std::uint32_t t = triangle_of_face[static_cast<std::size_t>(face.idx())];
        for (const Mesh::HalfedgeHandle side : mesh.fh_range(face)) {
            const Mesh::FaceHandle across = mesh.opposite_face_handle(side);
            const auto from = std::ranges::find(corners[t], mesh.from_vertex_handle(side));
            if (across.is_valid())
                neighbours[t][static_cast<std::size_t>(from - corners[t].begin())] =
                    triangle_of_face[static_cast<std::size_t>(across.idx())];
        }
    }
    return others;
}

void count_holes(const Mesh& mesh, HalfEdgeReport& report)
{
    std::vector<bool> seen(mesh.n_halfedges(), false);
    for (const Mesh::HalfedgeHandle start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || seen[static_cast<std::size_t>(start.idx())])
            continue;
        std::uint64_t edges = 0;
        for (Mesh::HalfedgeHandle at = start; !seen[static_cast<std::size_t>(at.idx())];
             at = mesh.next_halfedge_handle(at)) {
            seen[static_cast<std::size_t>(at.idx())] = true;
            ++edges;
        }
        ++report.hole_count;
        report.largest_hole_edges = std::max(report.largest_hole_edges, edges);
    }
}

/// Walks each component once; of the closed ones Euler's formula gives the handles.
void count_handles(const Mesh& mesh, HalfEdgeReport& report)
{
    std::vector<bool> seen_face(mesh.n_faces(), false);
    std::vector<bool> seen_vertex(mesh.n_vertices(), false);
    std::vector<Mesh::FaceHandle> queue;
    for (const Mesh::FaceHandle start : mesh.faces()) {
        if (seen_face[static_cast<std::size_t>(start.idx())])
            continue;
        seen_face[static_cast<std::size_t>(start.idx())] = true;
        queue.assign(1, start);
        std::uint64_t vertices = 0;
        bool closed = true;
        for (std::size_t head = 0; head < queue.size(); ++head) {
            for (const Mesh::HalfedgeHandle side : mesh.fh_range(queue[head])) {
                const auto vertex = static_cast<std::size_t>(mesh.to_vertex_handle(side).idx());
                vertices += seen_vertex[vertex] ? 0u : 1u;
                seen_vertex[vertex] = true;
                const Mesh::FaceHandle across = mesh.opposite_face_handle(side);
                if (!across.is_valid()) {
                    closed = false;
                } else if (!seen_face[static_cast<std::size_t>(across.idx())]) {
                    seen_face[static_cast<std::size_t>(across.idx())] = true;
                    queue.push_back(across);
                }
            }
        }
        // a closed triangle mesh has E = 3/2 F, so V - E + F = V - F / 2 = 2 - 2 genus
        const std::uint64_t faces = queue.size();
        if (closed && faces / 2 + 2 >= vertices)
            report.handle_count += (faces / 2 + 2 - vertices) / 2;
    }
}

}  // namespace

HalfEdgeReport examine_half_edges(const Geometry& geometry)
{
    HalfEdgeReport report;
    const Mesh mesh = build(geometry, report.complex_triangle_count);
    count_holes(mesh, report);
    count_handles(mesh, report);
    return report;
}

std::vector<Neighbours> neighbours_of(const Geometry& geometry)
{
    const std::size_t count = geometry.triangles.size();
    std::vector<Neighbours> neighbours(count, {kNoTriangle, kNoTriangle, kNoTriangle});
    std::vector<std::array<Mesh::VertexHandle, 3>> corners;
    corners.reserve(count);
    auto vertex_count = static_cast<std::uint32_t>(geometry.positions.size());
    FanParts parts(geometry);
    for (const glm::uvec3 triangle : geometry.triangles)
        corners.push_back(parts.corners_of(triangle, vertex_count));
    std::vector<std::uint32_t> rest(count);
    std::iota(rest.begin(), rest.end(), 0u);
    const QuietOpenMesh quiet;
    for (std::uint32_t mesh = 0; mesh < kMostMeshes && !rest.empty(); ++mesh)
        rest = join_in_one_mesh(corners, rest, vertex_count, neighbours);
    return neighbours;
}

}  // namespace surfelao
