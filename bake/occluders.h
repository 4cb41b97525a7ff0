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
    /// Of points; all must outlive it. squares: squares_of(cloud). ready: what is prepared of them
    /// already, or null.
    Occluders(const PointCloud& cloud, const Geometry& squares, const Prepared* ready)
        : geometry_(squares), cloud_(&cloud), ready_(ready)
    {
    }

    [[nodiscard]] const Geometry& geometry() const { return geometry_; }
    [[nodiscard]] bool has(const EngineChoice& choice) const
    {
        return is_ready(choice) || prepared_.contains(choice.engine);
    }

    /// The device and the instructions are those of the first choice of an engine. Throws as
    /// prepare().
    const Prepared& prepared_for(const EngineChoice& choice);

private:
    [[nodiscard]] bool is_ready(const EngineChoice& choice) const
    {
        return ready_ != nullptr && ready_->choice() == choice;
    }

    const Geometry& geometry_;
    const PointCloud* cloud_ = nullptr;
    const Prepared* ready_ = nullptr;
    std::map<Engine, Prepared> prepared_;
};

}  // namespace surfelao
