#include "files/scene_io.h"
#include "surfels/geometry.h"
#include "surfels/receiver.h"
#include "tree/masks/masks.h"

#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments)
{
    using namespace surfelao;
    if (argument_count != 3) {
        std::fprintf(stderr, "usage: example IN OUT\n");
        return 2;
    }
    try {
        const Scene scene = read_scene(arguments[1]);
        const Geometry geometry = make_geometry(scene);
        const auto tree = build_mask_tree(geometry);
        const MaskOptions options;
        const auto receivers = receivers_at_vertices(geometry, options.definition.offset);
        const auto occlusion = solve_masks(*tree, receivers, options);
        write_scene(arguments[2], scene, occlusion);

        double sum = 0.0;
        for (const Occlusion& at_vertex : occlusion)
            sum += at_vertex.occlusion;
        std::printf("mean occlusion %.3f\n", sum / static_cast<double>(occlusion.size()));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
