/// pixel_session.h: the pixels of one picture, solved in the background: a few of them first, then
/// all. Knows no window, and no device but that of the GPU's engines.
///
/// Which triangle a pixel sees is drawn by whoever has a device (gpu/g_buffer.h). A window does so
/// in its own context: that costs it one frame, the model lies on the device once, and methods that
/// ask the picture alone need the drawing anyway.
#pragma once

#include "engines/engine.h"
#include "gpu/g_buffer.h"
#include "surfels/occlusion.h"
#include "viewer/background_worker.h"
#include "viewer/mailbox.h"
#include "viewer/model.h"
#include "viewer/own_engine.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {

/// Pixels at which a picture's error is told: its RMSE is right to a fiftieth or so of itself.
inline constexpr std::size_t kErrorPixels = 4000;

struct PixelQuestion {
    std::shared_ptr<const Model> model;  ///< a mesh's
    View view;
    int width = 0, height = 0;             ///< of the picture
    std::vector<std::uint32_t> triangles;  ///< GBuffer::read_triangles() of its geometry
    EngineSettings engine;                 ///< with the definition; its context does not count
    /// Of the model for that engine, used beside others: on the CPU alone. Null: the session
    /// prepares one of its own and keeps it for other questions.
    std::shared_ptr<const Prepared> prepared = {};
    std::size_t sample = 0;  ///< first so many pixels, spread over the picture
    bool whole = true;       ///< then the picture; else that was all
};

/// Some of the pixels.
struct PixelSample {
    std::vector<std::uint32_t> pixels;  ///< column + width * row, row 0 at the bottom; rising
    std::vector<Occlusion> values;      ///< one per pixel
};

struct PixelAnswers {
    PixelSample sample;  ///< empty until it was solved
    int width = 0, height = 0;
    /// All pixels, row by row from the bottom: bent normal, occlusion; zero where nothing is seen.
    /// Empty until there is a draft. The whole has the values that answer() (pixels/pixel_engine.h)
    /// finds.
    std::vector<glm::vec4> picture;
    bool is_draft = false;
    double seconds = 0.0;  ///< of solving the whole
    std::string message;   ///< what went wrong, one sentence; else empty
};

/// For one thread; update() takes over what the background thread has finished.
class PixelSession {
public:
    PixelSession() : worker_([this] { own_.end(); }) {}

    /// Gives up what runs and forgets what was found: it is of another picture.
    void solve(PixelQuestion question);
    /// The same without another question.
    void forget();
    /// Gives up what runs; what was found stays.
    void cancel() { worker_.cancel(); }

    /// Whether answers() have changed since the last call.
    [[nodiscard]] bool update();
    const PixelAnswers& answers() const { return answers_; }

    bool solving() const { return worker_.busy(); }
    /// Whether answers are still to come: from the thread, or by the next update().
    bool is_busy() const { return solving() || found_.is_full(); }
    double progress() const { return worker_.progress(); }

private:
    void find(std::uint64_t number, const PixelQuestion& question, const Progress& progress);

    PixelAnswers answers_;
    OwnEngine own_;  ///< used by the background thread alone
    Mailbox<PixelAnswers> found_;
    BackgroundWorker worker_;  // last: its thread writes to the above
};

}  // namespace surfelao
