#include "surfelao/surfelao.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace surfelao;

int main(int argument_count, char** arguments)
try {
    if (argument_count < 3)
        throw InputError("usage: example IN OUT [QUALITY]");
    const float quality = argument_count > 3 ? std::strtof(arguments[3], nullptr) : kGood;
    check_settings({}, {.quality = quality});               // throws before any work is done
    const Mesh mesh = make_mesh(read_scene(arguments[1]));  // or make_scene(positions, triangles)
    const Prepared prepared = prepare(mesh.geometry);

    // one per vertex, then one for each further side of hard edges
    auto vertices = receivers_at_wedges(mesh.geometry, mesh.surface);
    vertices.resize(mesh.surface.vertex_count());
    auto above = vertices;
    for (Receiver& receiver : above)
        receiver.position += 0.05f * receiver.normal;  // a twentieth of the scene's diagonal
    Solution solution;
    for (const auto& [name, receivers] : {std::pair("above", above), {"at", vertices}}) {
        for (const float q : {kDraft, quality}) {
            solution = solve(prepared, receivers, {.quality = q});
            std::printf("%s the vertices, quality %g: the first is %.3f, all in %.4f s\n", name, q,
                        solution.occlusion[0].occlusion, solution.seconds);
        }
    }
    write_scene(arguments[2], mesh.scene, solution.occlusion);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
