#include "surfelao/surfelao.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace surfelao;

std::vector<Occlusion> ask(const Prepared& prepared, std::span<const Receiver> receivers,
                           float quality, const char* where)
{
    const Solution solution = solve(prepared, receivers, {.quality = quality});
    double sum = 0.0;
    for (const Occlusion& answer : solution.occlusion)
        sum += answer.occlusion;
    std::printf("%s, quality %g: mean occlusion %.3f in %.4f s\n", where, quality,
                sum / static_cast<double>(receivers.size()), solution.seconds);
    return solution.occlusion;
}

int main(int argument_count, char** arguments)
try {
    if (argument_count < 3)
        throw InputError("usage: example IN OUT [QUALITY]");
    const float quality = argument_count > 3 ? std::strtof(arguments[3], nullptr) : kGood;
    check_settings({}, {.quality = quality});      // throws before any work is done
    const Scene scene = read_scene(arguments[1]);  // or make_scene(positions, triangles)
    const Geometry geometry = make_geometry(scene);
    const Prepared prepared = prepare(geometry);

    const std::vector<Receiver> vertices = receivers_at_vertices(geometry, Definition{}.offset);
    std::vector<Receiver> above = vertices;
    for (Receiver& receiver : above)
        receiver.position += 0.05f * receiver.normal;  // a twentieth of the scene's diagonal
    ask(prepared, vertices, kDraft, "at the vertices");
    ask(prepared, above, kDraft, "above them");
    ask(prepared, above, quality, "above them");
    write_scene(arguments[2], scene, ask(prepared, vertices, quality, "at the vertices"));
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
