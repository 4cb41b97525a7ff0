/// cube_session.h: the long work that cube maps of a model take, in the background: where they
/// should be, and what their texels answer. Knows no window.
#pragma once

#include "engines/engine.h"
#include "pixels/cube_map.h"
#include "pixels/cube_placement.h"
#include "viewer/background_worker.h"
#include "viewer/mailbox.h"
#include "viewer/model.h"
#include "viewer/own_engine.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace surfelao {

/// Of one map.
struct CubeQuestion {
    std::shared_ptr<const Model> model;
    EngineSettings engine;                          ///< with the definition
    std::shared_ptr<const Prepared> prepared = {};  ///< as PixelQuestion's
    std::shared_ptr<const CubeSight> sight;
};

/// For one thread; update() takes over what the background thread has finished.
class CubeSession {
public:
    CubeSession() : worker_([this] { own_.end(); }) {}

    /// Both give up what runs.
    void solve(CubeQuestion question);
    void place(std::shared_ptr<const Model> model);
    void cancel();

    /// What was finished since the last call: at most one of these.
    struct News {
        std::optional<CubeMap> map;
        std::optional<CubePlacement> placement;
        std::string failure;  ///< one sentence; else empty
    };
    [[nodiscard]] News update();

    /// Until update() has told what came of it.
    bool busy() const { return is_running_; }
    bool placing() const { return is_running_ && is_placing_; }
    double progress() const { return worker_.progress(); }

private:
    void start(std::function<void(News&, const Progress&)> work);
    bool is_running_ = false, is_placing_ = false;
    OwnEngine own_;  ///< used by the background thread alone
    Mailbox<News> news_;
    BackgroundWorker worker_;  // last: its thread writes to the above
};

}  // namespace surfelao
