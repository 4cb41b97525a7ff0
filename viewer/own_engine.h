/// own_engine.h: an engine that a background thread keeps for a model.
#pragma once

#include "engines/engine.h"
#include "viewer/model.h"
#include "viewer/solve_model.h"

#include <memory>
#include <optional>

namespace surfelao {

/// For one thread, which must also end it: an engine of the GPU has a context of its own.
class OwnEngine {
public:
    /// Prepared when it is first asked for, and again of another model or choice.
    const Prepared& prepared_for(const std::shared_ptr<const Model>& model, EngineChoice choice)
    {
        choice.context = nullptr;
        if (model_ != model || !prepared_ || prepared_->choice() != choice) {
            prepared_.reset();  // before the next one is built: both may be large
            model_ = model;
            prepared_.emplace(prepare(*model, choice));
        }
        return *prepared_;
    }

    void end() { prepared_.reset(); }

private:
    std::shared_ptr<const Model> model_;
    std::optional<Prepared> prepared_;
};

}  // namespace surfelao
