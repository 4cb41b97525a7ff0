/// grid_session.h: the AO grid round what occludes in a model, or one round each of its objects,
/// made in the background. Knows no window, and no device but that of the GPU's engines.
#pragma once

#include "bake/grid_target.h"
#include "engines/engine.h"
#include "viewer/background_worker.h"
#include "viewer/grid_objects.h"
#include "viewer/mailbox.h"
#include "viewer/model.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {

struct GridQuestion {
    std::shared_ptr<const Model> model;          ///< a mesh's
    std::shared_ptr<const GridObjects> objects;  ///< of it; null: all that occludes is one
    GridSettings grid;
    EngineSettings engine;  ///< with the model's definition, whose ground does not count
    bool operator==(const GridQuestion&) const = default;
};

/// In the file's units; without the statement of its error.
struct ObjectGrid : GridBake {
    /// One per triangle of the object (GridObjects::triangles): what the object leaves of the light
    /// at its corners by itself. Empty where all that occludes is one.
    std::vector<glm::vec3> own;
};

struct FoundGrids {
    GridQuestion question;
    std::vector<std::shared_ptr<const ObjectGrid>> bakes;  ///< one per object
};

/// For one thread; update() takes over what the background thread has finished. Objects that are
/// also of one of the last two questions that were answered, for the same model and settings, have
/// their grids from there.
class GridSession {
public:
    /// Does nothing where it is the last question. Gives up what runs otherwise, and what was found
    /// stays until there are other grids: found() at once where none needs to be made.
    void ask(GridQuestion question);
    void forget();
    /// Gives up what runs; what was found stays.
    void cancel();
    void ask_again();  ///< after cancel()

    /// Whether there are other grids.
    [[nodiscard]] bool update();

    /// Null until there are some.
    const std::shared_ptr<const FoundGrids>& found() const { return found_; }
    /// Of the last question; null where there is none.
    const std::shared_ptr<const Model>& model() const { return question_.model; }
    const std::string& message() const { return message_; }  ///< what went wrong; else empty
    bool was_cancelled() const { return was_cancelled_; }    ///< the last question, before its end
    bool solving() const { return worker_.busy() || news_.is_full(); }
    double progress() const { return worker_.progress(); }  ///< of all grids that are to be made

private:
    void start();
    void take(std::shared_ptr<const FoundGrids> found);
    [[nodiscard]] std::shared_ptr<const ObjectGrid> known(std::size_t object) const;

    GridQuestion question_;  ///< without a model: none
    bool was_cancelled_ = false;
    std::shared_ptr<const FoundGrids> found_, before_;
    std::string message_;

    struct News {
        std::shared_ptr<const FoundGrids> found;
        std::string failure;  ///< if not empty, there are no grids
    };
    Mailbox<News> news_;
    BackgroundWorker worker_;  // last: its thread writes to the above
};

}  // namespace surfelao
