/// session.h: what happens behind a window: reading a file, solving it in the background, a rough
/// answer first, and tracing the reference. Knows neither window nor device.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/scene.h"
#include "viewer/background_worker.h"
#include "viewer/camera.h"
#include "viewer/model.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// What an engine can be told, for the widgets.
struct EngineTraits {
    std::string name;
    float least_quality = 0.0f;     ///< quality runs from this ...
    float most_quality = 0.0f;      ///< ... to this; 0 = it has none
    bool has_disk_options = false;  ///< passes and strength
    bool has_rays = false;          ///< rays per receiver
};

/// What is solved, and how. Equal settings give equal answers.
struct SessionSettings {
    std::size_t engine = 0;  ///< into Services::engines
    float quality = 1.0f;
    int passes = 2;
    float strength = 1.0f;
    int rays = 256;
    float max_distance_percent = 0.0f;  ///< of the diagonal; 0 = unlimited
    bool smooth_falloff = false;        ///< only with a distance limit
    bool operator==(const SessionSettings&) const = default;
};

/// What is measured by these settings.
[[nodiscard]] Definition definition_of(const SessionSettings& settings);

struct Solved {
    std::vector<Occlusion> occlusion;  ///< one per receiver of the model
    double build_s = 0.0;              ///< seconds: what the engine makes of the geometry first
    double solve_s = 0.0;
};

/// Errors against the reference, over vertices whose question has an answer.
struct ErrorFigures {
    double rmse = 0.0;
    double bias = 0.0;  ///< positive = too dark
    double p95 = 0.0;
    double max = 0.0;
};

/// What the caller lends: the engines, which lie above this folder.
struct Services {
    std::vector<EngineTraits> engines;  ///< at least one
    /// In a background thread. Throws Cancelled when progress says so.
    std::function<Solved(const Model&, const SessionSettings&, const Progress&)> solve;
    std::function<ErrorFigures(std::span<const Occlusion> answer,
                               std::span<const Occlusion> reference)>
        measure;
};

/// A picture of the session for one frame.
struct SessionState {
    std::filesystem::path path;          ///< of the model shown
    std::shared_ptr<const Scene> scene;  ///< null until a file was read
    std::shared_ptr<const Model> model;
    std::vector<Occlusion> occlusion;  ///< empty until something was solved
    std::vector<Occlusion> reference;  ///< empty until it was traced for the same definition
    bool is_draft = false;             ///< `occlusion` is the rough answer
    double read_s = 0.0, build_s = 0.0, solve_s = 0.0, reference_s = 0.0;
    std::optional<ErrorFigures> error;  ///< of `occlusion` against `reference`
    std::string message;  ///< the last thing that went wrong, one sentence; else empty
};

/// For one thread, the window's; update() takes over what the background threads have finished.
class Session {
public:
    explicit Session(Services services);
    ~Session();

    /// Reads a file in the background, then solves it with the last settings. What is shown stays
    /// until the file turns out to be readable.
    void open(const std::filesystem::path& path, UpAxis up);

    /// Solves the model with these settings: a draft first where the engine has one, then the
    /// whole. What is running is given up. Does nothing when they are the last settings.
    void solve(const SessionSettings& settings);

    /// An even number of rays: the reference is traced now and whenever the definition changes.
    /// 0: no more.
    void want_reference(std::uint32_t rays);

    /// Stops solving and tracing; the last answers stay.
    void cancel();

    /// Solves the model once more with the last settings, after cancel().
    void solve_again();

    /// What changed in state() since the last call.
    struct Changes {
        bool model = false, occlusion = false, reference = false;
    };
    [[nodiscard]] Changes update();

    const SessionState& state() const { return state_; }
    const Services& services() const { return services_; }
    const SessionSettings& settings() const { return settings_; }
    bool opening() const { return opening_; }
    bool was_cancelled() const { return was_cancelled_; }  ///< the last solving, before its end
    bool solving() const { return solver_.busy(); }
    bool tracing() const { return tracer_.busy(); }
    double solve_progress() const { return solver_.progress(); }
    double trace_progress() const { return tracer_.progress(); }

private:
    struct Read;
    struct Answer;
    struct Traced;
    void start_solve();
    void start_reference();
    void measure();

    Services services_;
    SessionSettings settings_;
    std::uint32_t reference_rays_ = 0;
    bool opening_ = false;
    bool was_cancelled_ = false;
    SessionState state_;
    std::vector<bool> has_answer_;  ///< per vertex, by the reference

    // written by the background threads, taken by update(); what was started before the last model
    // or settings carries an old number and is dropped
    std::mutex mailbox_;
    std::unique_ptr<Read> read_;
    std::unique_ptr<Answer> answer_;
    std::unique_ptr<Traced> traced_;
    std::string failure_;
    std::uint64_t solve_number_ = 0, trace_number_ = 0;

    BackgroundWorker solver_, tracer_;  // last: their threads write to the above
};

}  // namespace surfelao
