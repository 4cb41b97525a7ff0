// The glTF reader on any bytes: refuses them in one sentence, or gives a scene that keeps its
// promises and that survives being written and read again.
#include "scene_checks.h"

#include "files/gltf_io.h"
#include "files/motion.h"
#include "surfels/errors.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace surfelao;

/// All corners apart.
UvSet new_places(const Scene& scene)
{
    UvSet uvs;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        uvs.corners.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
        for (std::uint32_t k = 0; k < 3; ++k)
            uvs.values.emplace_back(0.25 * k, 1.0 / (t + 1.0));
    }
    return uvs;
}

void check_same(const Scene& again, const Scene& scene)
{
    SURFELAO_CHECK(again.positions == scene.positions);
    SURFELAO_CHECK(again.triangles == scene.triangles);
    SURFELAO_CHECK(again.normals.values == scene.normals.values);
}

void check_round_trip(const Scene& scene)
{
    const OcclusionMap map{"", 0, new_places(scene)};
    const std::vector<Occlusion> occlusion(scene.positions.size(), {0.5f, {0.0f, 0.0f, 1.0f}});
    for (const char* path : {"/no folder/a.glb", "/no folder/a.gltf"}) {
        check_same(read_gltf(path, gltf_contents(path, scene, occlusion).contents), scene);
        check_same(read_gltf(path, gltf_contents_with_map(path, scene, map).contents), scene);
    }
}

/// Poses are finite, one per part, and those that deform are whole.
void check_motion(const Scene& scene)
{
    const Motion motion(scene);
    const std::vector<PartPose> poses = motion.at(0.3);
    SURFELAO_CHECK(poses.size() == scene.parts.size());
    for (std::size_t p = 0; p < poses.size(); ++p) {
        SURFELAO_CHECK(motion.bodies()[p] < motion.body_count());
        SURFELAO_CHECK(poses[p].positions.empty() ||
                       poses[p].positions.size() == scene.parts[p].vertex_count);
        for (const glm::dvec3& position : poses[p].positions)
            SURFELAO_CHECK(std::isfinite(position.x + position.y + position.z));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string contents(reinterpret_cast<const char*>(data), size);
    try {
        check_invariants(read_gltf("/no folder/fuzzed", contents, Moment{0.3}));
    } catch (const InputError&) {
    }
    try {
        const Scene scene = read_gltf("/no folder/fuzzed", contents);
        check_invariants(scene);
        if (scene.positions.size() < 10'000)
            check_round_trip(scene);
        check_motion(scene);
    } catch (const InputError&) {
    }
    return 0;
}
