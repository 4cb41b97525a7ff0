/// occluders.h: what occludes in a job, and the engines that are prepared of it.
#pragma once

#include "engines/engine.h"
#include "surfels/geometry.h"

#include <map>

namespace surfelao {

/// Engines over one geometry, each prepared once, when it is first asked for. One thread at a time.
class Occluders {
public:
    /// geometry must outlive it.
    explicit Occluders(const Geometry& geometry) : geometry_(geometry) {}

    [[nodiscard]] const Geometry& geometry() const { return geometry_; }
    [[nodiscard]] bool has(Engine engine) const { return prepared_.contains(engine); }

    /// The device and the instructions are those of the first choice of an engine. Throws as
    /// prepare().
    const Prepared& prepared_for(const EngineChoice& choice);

private:
    const Geometry& geometry_;
    std::map<Engine, Prepared> prepared_;
};

}  // namespace surfelao
