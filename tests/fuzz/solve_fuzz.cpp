// Any bytes as a scene, receivers, an engine and its settings: no engine may crash, answer with
// what is no number or outside its range, or answer twice differently.
#include "scene_checks.h"

#include "reference/rays.h"
#include "surfels/surfel.h"
#include "tests/stability/judge.h"
#include "tree/disks/disks.h"
#include "tree/masks/masks.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace surfelao;
using namespace surfelao::stability;

namespace {

/// Reads bytes one after the other; behind the end all are 0.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    [[nodiscard]] bool empty() const { return at_ >= size_; }
    std::uint8_t byte() { return empty() ? std::uint8_t{0} : data_[at_++]; }

    template <class T, std::size_t n>
    T one_of(const T (&values)[n])
    {
        return values[byte() % n];
    }

    float share() { return static_cast<float>(byte()) / 255.0f; }

    /// One byte for one of a few places, which then coincide often; some bytes ask for another one
    /// that says how far beside such a place, down to the last bit, or how far out.
    double coordinate()
    {
        const std::uint8_t code = byte();
        const double place = (code % 32 - 16) / 8.0;
        switch (code / 32) {
            case 0:
            case 1:
            case 2:
            case 3:
            case 4:
                return place;
            case 5:
                return place + std::ldexp(1.0, -byte() % 60);
            case 6:
                return place * (1.0 + std::ldexp(1.0, -byte() % 60));
            default:
                return std::ldexp(place, byte() % 201 - 100);
        }
    }

    glm::dvec3 point()
    {
        const double x = coordinate(), y = coordinate(), z = coordinate();
        return {x, y, z};
    }

private:
    const std::uint8_t* data_;
    std::size_t size_;
    std::size_t at_ = 0;
};

constexpr std::size_t kMostVertices = 256;
constexpr std::size_t kMostTriangles = 400;
constexpr std::size_t kMostReceivers = 32;
/// An opening of 0 asks every disk at every other one: of 1,024 that takes 10 s.
constexpr std::size_t kMostSurfels = 256;

template <class Options>
Options with(Options options, const SolveSettings& settings)
{
    options.definition = settings.definition;
    return options;
}

stability::Engine engine_of(Bytes& bytes)
{
    stability::Engine engine;
    switch (bytes.byte() % 4) {
        case 0: {
            RayOptions options;
            options.rays = 16;
            const auto build = bytes.one_of({RayScene::Build::robust, RayScene::Build::fast});
            engine.name = "rays";
            engine.prepare = [=](const Geometry& geometry) -> Solver {
                return [=, scene = std::make_shared<const RayScene>(geometry, build)](
                           std::span<const Receiver> receivers, const SolveSettings& settings) {
                    return trace_occlusion(*scene, receivers, with(options, settings));
                };
            };
            break;
        }
        case 1: {
            DiskOptions options;
            options.opening = 0.95f * bytes.share();
            options.passes = 1 + bytes.byte() % 4;
            options.strength = bytes.one_of({1.0f, 0.0f, 0.7f, 3.0f});
            const bool even = bytes.byte() >= 240;  // triangles of their own: rarely
            engine.name = "disks";
            engine.prepare = [=](const Geometry& geometry) -> Solver {
                SurfelCloud cloud = even ? surfels_of(geometry) : SurfelCloud{};
                const std::size_t kept = std::min(cloud.surfels.size(), kMostSurfels);
                cloud.surfels.resize(kept);
                cloud.vertices.resize(kept);
                const Octree octree =
                    even ? build_octree(cloud.surfels, sides_of(cloud, analyse_topology(geometry)))
                         : build_octree(surfels_at_vertices(geometry));
                return [=](std::span<const Receiver> receivers, const SolveSettings& settings) {
                    return solve_disks(octree, receivers, with(options, settings)).occlusion;
                };
            };
            break;
        }
        default: {
            MaskOptions options;
            options.quality = MaskOptions::kCoarsest +
                              (MaskOptions::kFinest - MaskOptions::kCoarsest) * bytes.share();
            const std::vector<MaskKernelSet> kernels = available_mask_kernels();
            options.kernel = kernels[bytes.byte() % kernels.size()];
            options.exact = bytes.byte() >= 224;
            engine.name = "masks " + std::string(name_of(options.kernel));
            engine.prepare = [=](const Geometry& geometry) -> Solver {
                return [=, tree = build_mask_tree(geometry)](std::span<const Receiver> receivers,
                                                             const SolveSettings& settings) {
                    return solve_masks(*tree, receivers, with(options, settings));
                };
            };
        }
    }
    return engine;
}

/// sums: the engine knows more kernels than the cosine.
Definition definition_of(Bytes& bytes, bool sums)
{
    Definition definition;
    definition.max_distance =
        bytes.one_of({std::numeric_limits<float>::infinity(), 1.0f, 0.1f, 1e-3f, 1e-7f});
    if (definition.max_distance < 2.0f)
        definition.falloff = bytes.one_of({Falloff::none, Falloff::smooth});
    if (sums)
        definition.kernel = bytes.one_of({Kernel::cosine, Kernel::bunnell});
    return definition;
}

Scene scene_of(Bytes& bytes)
{
    Scene scene;
    const double scale = bytes.one_of({1.0, 1e-30, 1e30, 1e-6});
    const glm::dvec3 place = bytes.one_of({0.0, 0.0, 1e7, -1e3}) * bytes.point();
    const std::size_t vertices = 3 + bytes.byte() % (kMostVertices - 3);
    for (std::size_t v = 0; v < vertices; ++v)
        scene.positions.push_back(scale * (bytes.point() + place));
    const std::size_t triangles = 1 + (bytes.byte() + 256u * bytes.byte()) % kMostTriangles;
    const auto corner = [&] { return static_cast<std::uint32_t>(bytes.byte() % vertices); };
    for (std::size_t t = 0; t < triangles && !bytes.empty(); ++t) {
        const std::uint32_t a = corner(), b = corner(), c = corner();
        scene.triangles.emplace_back(a, b, c);
    }
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(vertices);
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    scene.parts.push_back(part);
    return scene;
}

/// At the vertices, and anywhere else with any normal.
std::vector<Receiver> receivers_of(Bytes& bytes, const World& world)
{
    std::vector<Receiver> receivers = world.receivers;
    receivers.resize(std::min(receivers.size(), kMostReceivers));
    while (receivers.size() < kMostReceivers && !bytes.empty()) {
        const glm::vec3 position = glm::clamp(glm::vec3(bytes.point()), -4.0f, 4.0f);
        const glm::dvec3 normal = bytes.point();
        const double length = glm::length(normal);
        receivers.push_back({position, length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0)});
    }
    return receivers;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes(data, size);
    const stability::Engine engine = engine_of(bytes);
    const float offset = bytes.one_of({1e-4f, 1e-9f, 1e-6f, 1e-2f});
    const Definition definition = definition_of(bytes, !engine.name.starts_with("masks"));
    const Scene scene = scene_of(bytes);
    if (scene.triangles.empty())
        return 0;
    check_geometry(scene);
    World world = at_vertices(scene, definition, offset);
    world.receivers = receivers_of(bytes, world);
    Built built;
    const std::string fault = solve_twice(world, engine, built).fault;
    if (!fault.empty())
        std::fprintf(stderr, "%s: %s\n", engine.name.c_str(), fault.c_str());
    SURFELAO_CHECK(fault.empty());
    return 0;
}
