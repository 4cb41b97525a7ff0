// The glTF reader on any bytes: refuses them in one sentence, or gives a scene that keeps its
// promises and that survives being written and read again.
#include "scene_checks.h"

#include "files/gltf_io.h"
#include "surfels/errors.h"

#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace surfelao;

void check_round_trip(const Scene& scene)
{
    const std::vector<Occlusion> occlusion(scene.positions.size(), {0.5f, {0.0f, 0.0f, 1.0f}});
    for (const char* path : {"/no folder/a.glb", "/no folder/a.gltf"}) {
        const Scene again = read_gltf(path, gltf_contents(path, scene, occlusion).contents);
        SURFELAO_CHECK(again.positions == scene.positions);
        SURFELAO_CHECK(again.triangles == scene.triangles);
        SURFELAO_CHECK(again.normals.values == scene.normals.values);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        const Scene scene =
            read_gltf("/no folder/fuzzed", std::string(reinterpret_cast<const char*>(data), size));
        check_invariants(scene);
        if (scene.positions.size() < 10'000)
            check_round_trip(scene);
    } catch (const InputError&) {
    }
    return 0;
}
