/// cube_session.h: cube maps of a model, one after the other solved in the background. Knows no
/// window: what maps see is drawn by whoever has a device (pixels/cube_map.h).
#pragma once

#include "engines/engine.h"
#include "pixels/cube_map.h"
#include "viewer/background_worker.h"
#include "viewer/model.h"
#include "viewer/own_engine.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace surfelao {

/// Who answers the texels.
struct CubeQuestion {
    std::shared_ptr<const Model> model;
    EngineSettings engine;                          ///< with the definition
    std::shared_ptr<const Prepared> prepared = {};  ///< as PixelQuestion's
};

/// For one thread; update() takes over what the background thread has finished.
class CubeSession {
public:
    CubeSession() : worker_([this] { own_.end(); }) {}

    /// Maps are answered so from now on. Those that are there are solved again; without them there
    /// is nothing to do.
    void ask(CubeQuestion question);

    /// One more map.
    void add(std::shared_ptr<const CubeSight> sight);

    /// All maps are forgotten: of another model.
    void forget();

    /// The maps that were finished since the last call.
    [[nodiscard]] std::vector<CubeMap> update();

    std::size_t count() const { return sights_.size(); }  ///< with those that are not solved yet
    bool solving() const { return next_ < sights_.size() || worker_.busy(); }
    double progress() const { return worker_.progress(); }
    const std::string& message() const { return message_; }  ///< what went wrong; else empty

    /// Gives up what runs; maps that are not solved yet are forgotten.
    void cancel();

private:
    void start_next();

    CubeQuestion question_;
    std::vector<std::shared_ptr<const CubeSight>> sights_;
    std::size_t next_ = 0;      ///< of the sights, that is not solved
    bool is_running_ = false;   ///< it is
    std::uint64_t number_ = 0;  ///< of what runs; other answers are dropped
    std::string message_;
    OwnEngine own_;  ///< used by the background thread alone

    struct Found {
        std::uint64_t number = 0;
        CubeMap map;
        std::string failure;  ///< if not empty, there is no map
    };
    std::mutex mailbox_;
    std::unique_ptr<Found> found_;  // written by the background thread

    BackgroundWorker worker_;  // last: its thread writes to the above
};

}  // namespace surfelao
