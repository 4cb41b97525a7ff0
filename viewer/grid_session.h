/// grid_session.h: the AO grid round what occludes in a model, made in the background. Knows no
/// window, and no device but that of the GPU's engines.
#pragma once

#include "bake/grid_target.h"
#include "engines/engine.h"
#include "viewer/background_worker.h"
#include "viewer/mailbox.h"
#include "viewer/model.h"

#include <memory>
#include <string>

namespace surfelao {

struct GridQuestion {
    std::shared_ptr<const Model> model;  ///< a mesh's
    GridSettings grid;
    EngineSettings engine;  ///< with the definition, whose ground does not count
    bool operator==(const GridQuestion&) const = default;
};

/// For one thread; update() takes over what the background thread has finished.
class GridSession {
public:
    /// Does nothing where it is the last question. Gives up what runs otherwise, and what was found
    /// stays until there is another grid.
    void ask(GridQuestion question);
    void forget();
    /// Gives up what runs; what was found stays.
    void cancel();
    void ask_again();  ///< after cancel()

    /// Whether there is another grid.
    [[nodiscard]] bool update();

    /// Null until there is one; without the statement of its error.
    const std::shared_ptr<const GridBake>& found() const { return found_; }
    const std::string& message() const { return message_; }  ///< what went wrong; else empty
    bool was_cancelled() const { return was_cancelled_; }    ///< the last question, before its end
    bool solving() const { return worker_.busy() || news_.is_full(); }
    double progress() const { return worker_.progress(); }

private:
    void start();
    GridQuestion question_;
    bool is_asked_ = false, was_cancelled_ = false;
    std::shared_ptr<const GridBake> found_;
    std::string message_;

    struct News {
        std::shared_ptr<const GridBake> bake;
        std::string failure;  ///< if not empty, there is no grid
    };
    Mailbox<News> news_;
    BackgroundWorker worker_;  // last: its thread writes to the above
};

}  // namespace surfelao
