#include "engines/moving_engine.h"
#include "engines/options.h"
#include "surfels/stopwatch.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/disks/disk_forest.h"
#include "tree/disks/disk_memory.h"

#include <set>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

/// A body's triangles over its own vertices.
struct DiskMesh {
    Scene scene;
    std::vector<std::uint32_t> vertices;  ///< of the geometry, one per vertex of the scene
    Topology topology;
};

/// In the unit frame as it is.
Geometry geometry_of(const Scene& scene)
{
    return make_geometry(scene, {.frame = Frame{}});
}

std::vector<DiskMesh> meshes_of(const MovingParts& parts)
{
    std::vector<DiskMesh> meshes(parts.bodies);
    std::vector<std::uint32_t> owner(parts.at_rest.positions.size(), parts.bodies);
    std::vector<std::uint32_t> place(owner.size());
    std::vector<std::vector<std::uint32_t>> triangles(parts.bodies);
    for (std::uint32_t t = 0; t < parts.body_of_triangle.size(); ++t)
        triangles[parts.body_of_triangle[t]].push_back(t);
    for (std::uint32_t b = 0; b < parts.bodies; ++b) {
        Scene& scene = meshes[b].scene;
        for (const std::uint32_t t : triangles[b]) {
            glm::uvec3 triangle = parts.at_rest.triangles[t];
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = triangle[corner];
                if (std::exchange(owner[vertex], b) != b) {
                    place[vertex] = static_cast<std::uint32_t>(scene.positions.size());
                    meshes[b].vertices.push_back(vertex);
                    scene.positions.emplace_back(parts.at_rest.positions[vertex]);
                }
                triangle[corner] = place[vertex];
            }
            scene.triangles.push_back(triangle);
        }
        meshes[b].topology = analyse_topology(geometry_of(scene));
    }
    return meshes;
}

Octree octree_of(const DiskMesh& mesh, double large)
{
    const SurfelCloud cloud = surfels_of(geometry_of(mesh.scene), large);
    return build_octree(cloud.surfels, sides_of(cloud, mesh.topology));
}

DiskForest forest_of(const std::vector<DiskMesh>& meshes, double large)
{
    std::vector<Octree> octrees;
    for (const DiskMesh& mesh : meshes)
        octrees.push_back(octree_of(mesh, large));
    return DiskForest(std::move(octrees));
}

class MovingDiskMemory : public MovingMemory {
public:
    MovingDiskMemory(const DiskForest& forest, DiskMemory memory)
        : forest_(forest), memory_(std::move(memory))
    {
    }
    void deform(std::uint32_t body, std::span<const Receiver> at_rest) override
    {
        memory_.deform(body, at_rest);
    }
    void solve(std::span<const MovingBody> bodies, std::span<const Receiver> now,
               std::span<Occlusion> answers, FrameReport& report, const Progress& progress) override
    {
        static_cast<void>(bodies);  // the forest has been moved to them
        check_receivers(now);
        report.residual = residual_of(memory_.solve(forest_, now, answers, progress));
        report.solved = now.size();
    }

private:
    const DiskForest& forest_;
    DiskMemory memory_;
};

class MovingDisks : public MovingEngine {
public:
    MovingDisks(const MovingParts& parts, const EngineChoice& choice)
        : choice_(choice),
          large_(large_area(parts.at_rest)),
          meshes_(meshes_of(parts)),
          forest_(forest_of(meshes_, large_)),
          versions_(parts.bodies, 0)
    {
    }

    void move(std::span<const MovingBody> bodies, FrameReport& report) override
    {
        Stopwatch watch;
        for (std::uint32_t b = 0; b < bodies.size(); ++b) {
            const MovingBody& body = bodies[b];
            if (body.version == versions_[b])
                continue;
            if (!body.placement)
                forest_.hide(b);
            else if (body.form)
                deform(b, *body.form);
            else
                put(b, *body.placement);
            versions_[b] = body.version;
        }
        forest_.update();
        report.tree += watch.lap();
    }

    Solution solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                   const Progress& progress) const override
    {
        check_settings(choice_, settings);
        check_receivers(receivers);
        Stopwatch watch;
        Solution solution;
        DiskResult solved =
            solve_disks(forest_.octree(), receivers, disk_options(settings), progress);
        solution.occlusion = std::move(solved.occlusion);
        solution.residual = residual_of(solved.residuals);
        solution.seconds = watch.lap();
        return solution;
    }

    std::unique_ptr<MovingMemory> remember(std::span<const Receiver> at_rest,
                                           std::span<const std::uint32_t> body_of_receiver,
                                           const MovingSettings& settings) const override
    {
        return std::make_unique<MovingDiskMemory>(
            forest_, DiskMemory(forest_, at_rest, body_of_receiver, disk_options(settings)));
    }

private:
    void put(std::uint32_t body, const Placement& placement)
    {
        if (deformed_.erase(body) > 0)
            forest_.replace(body, octree_of(meshes_[body], large_));
        forest_.place(body, placement);
    }

    /// Built anew: that takes a twentieth of what solving does, and a refitted tree would not be
    /// the better one.
    void deform(std::uint32_t body, const std::vector<glm::vec3>& positions)
    {
        DiskMesh mesh = meshes_[body];
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
            mesh.scene.positions[v] = positions[mesh.vertices[v]];
        forest_.replace(body, octree_of(mesh, large_));
        deformed_.insert(body);
    }

    EngineChoice choice_;
    double large_;
    std::vector<DiskMesh> meshes_;
    DiskForest forest_;
    std::vector<std::uint64_t> versions_;  ///< of the bodies, as the forest has them
    std::set<std::uint32_t> deformed_;
};

}  // namespace

std::unique_ptr<MovingEngine> moving_disks(const MovingParts& parts, const EngineChoice& choice)
{
    return std::make_unique<MovingDisks>(parts, choice);
}

}  // namespace surfelao
