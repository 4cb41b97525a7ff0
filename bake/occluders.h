/// occluders.h: what occludes in a job, and the engines that are prepared of it.
#pragma once

#include "engines/engine.h"
#include "surfels/geometry.h"
#include "surfels/point_cloud.h"

#include <map>

namespace surfelao {

/// Engines over one geometry, each prepared once, when it is first asked for. One thread at a time.
class Occluders {
public:
    /// geometry must outlive it.
    explicit Occluders(const Geometry& geometry) : geometry_(geometry) {}
    /// Of points; both must outlive it. squares: squares_of(cloud).
    Occluders(const PointCloud& cloud, const Geometry& squares) : geometry_(squares), cloud_(&cloud)
    {
    }

    [[nodiscard]] const Geometry& geometry() const { return geometry_; }
    [[nodiscard]] bool has(Engine engine) const { return prepared_.contains(engine); }

    /// The device and the instructions are those of the first choice of an engine. Throws as
    /// prepare().
    const Prepared& prepared_for(const EngineChoice& choice);

private:
    const Geometry& geometry_;
    const PointCloud* cloud_ = nullptr;
    std::map<Engine, Prepared> prepared_;
};

}  // namespace surfelao
