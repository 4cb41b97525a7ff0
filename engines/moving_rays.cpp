#include "reference/moving_rays.h"
#include "engines/moving_engine.h"
#include "engines/options.h"

#include <optional>
#include <utility>

namespace surfelao {
namespace {

/// Answers depend on the frame alone, so nothing is remembered.
class MovingRays : public MovingEngine {
public:
    MovingRays(const Geometry& at_rest, std::vector<BodyMesh> bodies, const EngineChoice& choice)
        : MovingEngine(choice, bodies.size()),
          scene_(at_rest, std::move(bodies), isa_of(choice.instructions))
    {
    }

private:
    void hide(std::uint32_t body) override { scene_.hide(body); }
    void place(std::uint32_t body, const Placement& placement) override
    {
        scene_.place(body, matrix_of(placement));
    }
    void deform(std::uint32_t body, const std::vector<glm::vec3>& positions) override
    {
        scene_.deform(body, positions);
    }
    void settle() override { now_ = &scene_.now(); }
    Solution answer(std::span<const Receiver> receivers, const SolveSettings& settings,
                    const Progress& progress) const override
    {
        return {trace_occlusion(*now_, receivers, ray_options(settings), progress), 0.0,
                std::nullopt};
    }

    MovingRayScene scene_;
    const RayScene* now_ = &scene_.now();
};

}  // namespace

std::unique_ptr<MovingEngine> moving_rays(const Geometry& at_rest, std::vector<BodyMesh> bodies,
                                          const EngineChoice& choice)
{
    return std::make_unique<MovingRays>(at_rest, std::move(bodies), choice);
}

}  // namespace surfelao
