// Writes what blender_tangents.py holds against Blender: per triangle of a mesh its corners, each
// with position, place in the map (v up), normal, tangent and sign, and a point in it with a
// direction and what a map of tangent space would hold there.
//
//     tangent_frames IN OUT.txt
#include "atlas/tangents.h"
#include "files/scene_io.h"

#include <glm/geometric.hpp>

#include <cstdio>
#include <exception>
#include <fstream>

namespace surfelao {
namespace {

template <class Vector>
void print(std::ofstream& out, const Vector& vector)
{
    for (int k = 0; k < vector.length(); ++k)
        out << vector[k] << ' ';
}

void write_frames(const char* input, const char* output)
{
    // the mean over all faces, weighted by angles: what Blender has too, to the last digits
    const Mesh mesh = make_mesh(read_scene(input), {NormalSource::smooth, 180.0f});
    const UvSet& uvs = mesh.scene.uvs.at(0);
    const Tangents tangents = make_tangents(mesh, uvs);
    std::ofstream out(output);
    out.precision(9);
    for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        const glm::uvec3 triangle = mesh.geometry.triangles[t];
        const glm::uvec3 corners =
            uvs.corners.empty() ? triangle : uvs.corners[mesh.geometry.scene_triangle(t)];
        for (int k = 0; k < 3; ++k) {
            out << mesh.geometry.welded[triangle[k]] << ' ';
            print(out, mesh.scene.positions[triangle[k]]);
            out << uvs.values[corners[k]].x << ' ' << 1.0 - uvs.values[corners[k]].y << ' ';
            print(out, mesh.surface.normals[mesh.surface.corners(mesh.geometry)[t][k]]);
            print(out, tangents[3 * t + static_cast<std::uint32_t>(k)]);
        }
        const SurfacePoint point{t, {0.1f * static_cast<float>(t % 8), 0.2f}};
        const glm::vec3 normal = mesh.surface.normals[mesh.surface.corners(mesh.geometry)[t].x];
        const glm::vec3 direction = glm::normalize(normal + glm::vec3(0.3f, -0.5f, 0.6f));
        print(out, point.at);
        print(out, direction);
        print(out, to_tangent_space(mesh, tangents, point, direction));
        out << '\n';
    }
}

}  // namespace
}  // namespace surfelao

int main(int count, char** arguments)
try {
    if (count != 3) {
        std::fprintf(stderr, "tangent_frames IN OUT.txt\n");
        return 2;
    }
    surfelao::write_frames(arguments[1], arguments[2]);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
