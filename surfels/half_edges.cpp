#include "surfels/half_edges.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/Property.hh>

#include <algorithm>
#include <array>
#include <limits>
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

}  // namespace surfelao
