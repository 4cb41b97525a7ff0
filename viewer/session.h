/// session.h: what happens behind a window: reading a file, solving it in the background, a rough
/// answer first, and tracing the reference. Knows no window.
#pragma once

#include "bake/world.h"
#include "engines/engine.h"
#include "files/scene_io.h"
#include "pixels/camera.h"
#include "surfels/occlusion.h"
#include "surfels/scene.h"
#include "viewer/background_worker.h"
#include "viewer/mailbox.h"
#include "viewer/model.h"
#include "viewer/solve_map.h"
#include "viewer/solve_model.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// What is solved, and how. Equal settings give equal answers: those of bake().
struct SessionSettings {
    /// Its context is the session's, and its definition is made of the limit below and the scene's
    /// size: whatever stands there does not count.
    EngineSettings engine;
    DistanceLimit max_distance;
    TargetSettings target;
    /// A map in place of values at vertices: its charts, size and padding count.
    std::optional<TexelSettings> texels = {};
    PartChoice parts = {};  ///< who occludes, who is baked and shown
    /// Files of the same coordinates that are the model with the one that is open (joined_scene.h).
    std::vector<std::filesystem::path> beside = {};
    /// That occludes; its up is the model's.
    std::optional<GroundPlane> ground = {};
    bool operator==(const SessionSettings&) const = default;
};

struct PosedBodies;  // viewer/model_pose.h

/// What has moved a model.
struct PoseName {
    std::optional<Moment> moment = {};  ///< of an animation
    bool by_hand = false;
    std::shared_ptr<const PosedBodies> bodies = {};  ///< null: as it was read
    [[nodiscard]] bool is_rest() const { return !moment && !by_hand; }
};

/// A picture of the session for one frame.
struct SessionState {
    std::filesystem::path path;                 ///< of the model shown
    std::shared_ptr<const Model> model;         ///< null until a file was read
    PartChoice parts;                           ///< that it was made with
    std::vector<std::filesystem::path> beside;  ///< likewise
    PoseName pose;                              ///< that it is in
    bool is_solved = false;                     ///< there is an answer: Session::occlusion()
    bool is_draft = false;                      ///< it is the rough one
    std::vector<Occlusion> reference;  ///< empty until it was traced for the same definition
    /// The answer's, where it is a map; null where it is at vertices.
    std::shared_ptr<const ModelLayout> layout;
    std::shared_ptr<const ModelMap> map;
    std::shared_ptr<const ModelMap> map_reference;  ///< null until it was traced
    std::optional<StatedError> map_error;           ///< of a whole answer, as displayed
    /// Who has answered, for whoever asks more of the same model; null where that is the GPU.
    std::shared_ptr<const Prepared> prepared;
    std::uint64_t answer_count = 0;  ///< how many have come so far, drafts too
    double read_s = 0.0;
    std::optional<double> build_s;  ///< empty where what was built before has answered again
    double solve_s = 0.0;
    std::optional<double> reference_s;  ///< empty where it was read from the cache
    std::optional<ModelError> error;    ///< of the answer; empty where there is nothing to judge
    std::string message;  ///< the last thing that went wrong, one sentence; else empty

    [[nodiscard]] bool has_reference() const
    {
        return layout ? map_reference != nullptr : !reference.empty();
    }
};

/// For one thread, the window's; update() takes over what the background threads have finished.
/// An engine is prepared once per model, and solves drafts, whole answers and other settings until
/// another engine, device or model is wanted. On the GPU they compute in a context of the session's
/// own, made when it is first needed.
class Session {
public:
    Session();
    ~Session();

    /// Reads a file in the background, then solves it with the last settings. What is shown stays
    /// until the file turns out to be readable.
    void open(const std::filesystem::path& path, UpAxis up, const ReadOptions& reading = {});
    /// The same with these settings.
    void open(const std::filesystem::path& path, UpAxis up, const SessionSettings& settings,
              const ReadOptions& reading = {});

    /// The same model, under another sky: its shadow and what is measured of the sky follow, also a
    /// ground that occludes, which then lies below the lowest point.
    void set_up(UpAxis up);

    /// The model that another session shows, without reading or making it again; of the settings,
    /// only engine, distance and texels count.
    void open(const Session& other, const SessionSettings& settings);

    /// Solves the model with these settings: a draft first where the engine has one, then the
    /// whole. What is running is given up. Other targets, parts, files beside or another ground
    /// need another model: it is made first, of the scene that was read. Does nothing when they are
    /// the last settings.
    void solve(const SessionSettings& settings);

    /// The same of the model at hand, or that is being made: as open() of another session.
    void solve_as(const SessionSettings& settings);

    /// An even number of rays: the reference is traced now and whenever the definition changes.
    /// 0: no more.
    void want_reference(std::uint32_t rays);

    /// The same model in another pose (viewer/model_pose.h), with an answer at its vertices. It
    /// stays until the model is made anew. is_whole: the answer is of the last settings; else it is
    /// solved with them. A model must be there, and none be in the making.
    void take_pose(std::shared_ptr<const Model> posed, const PoseName& name, ModelAnswer answer,
                   bool is_whole);

    /// Of the model that is shown, which stays: what will move of it.
    void take_bodies(std::shared_ptr<const PosedBodies> bodies);

    /// Stops what is solved and traced, and drops what it has found: another pose is on its way.
    void give_up();

    /// Stops solving and tracing; the last answers stay.
    void cancel();

    /// Solves the model once more with the last settings, after cancel().
    void solve_again();

    /// What changed in state() since the last call.
    struct Changes {
        bool file = false;    ///< the model is of another file
        bool model = false;   ///< of another file, or made anew for other targets
        bool pose = false;    ///< or the same in another pose
        bool bodies = false;  ///< or what will move of it is told: take_bodies()
        bool occlusion = false;
        bool reference = false;
    };
    [[nodiscard]] Changes update();

    /// Model::answer_count() answers, with a map those of the ground alone; empty until something
    /// was solved.
    const std::vector<Occlusion>& occlusion() const { return occlusion_; }

    /// Writes the model with the answer at its vertices, the draft where there is no other: the
    /// bytes that bake() writes for these settings; several files as one. Of another pose the mark
    /// tells so, and the file is written anew, but for glTF, which keeps the places that it was
    /// read with. With a map, the model with it, or the picture alone (.png, .tif). Something must
    /// be solved. Replaces what stands there. Throws as check_output() and write_scene(), and
    /// InputError for a map of several pages.
    void save(const std::filesystem::path& path) const;

    const SessionState& state() const { return state_; }
    const SessionSettings& settings() const { return settings_; }
    /// What the settings ask of the model, which must be there.
    [[nodiscard]] Definition definition() const;
    /// Who has answered, for whoever asks more of the same model; null where whoever asks prepares
    /// an engine of its own: the GPU's, and that of a pose that the session has not solved itself.
    [[nodiscard]] std::shared_ptr<const Prepared> shared_engine(const EngineChoice& choice) const;
    /// Whether it is time to: there is the session's engine, or nothing to wait for.
    [[nodiscard]] bool can_be_asked(const EngineChoice& choice) const;
    bool making() const { return making_.has_value(); }  ///< another model
    bool opening() const { return making_.has_value() && !making_->scene; }
    bool was_cancelled() const { return was_cancelled_; }  ///< the last solving, before its end
    bool solving() const { return solver_.busy(); }
    bool tracing() const { return tracer_.busy(); }
    double solve_progress() const { return solver_.progress(); }
    double trace_progress() const { return tracer_.progress(); }

private:
    /// A model that is being made.
    struct Making {
        std::filesystem::path path;
        UpAxis up = UpAxis::y;
        std::shared_ptr<const Scene> scene;  ///< null: the file is read
        TargetSettings target;
        PartChoice parts;
        std::optional<GroundPlane> ground;
        std::vector<std::filesystem::path> beside;
        ReadOptions reading = {};
    };
    struct Made;
    struct Answer;
    /// By the solver's thread: one of them. A failure comes in place of a draft that nobody has
    /// taken yet.
    struct Solved {
        std::unique_ptr<Made> made;
        std::unique_ptr<Answer> answer;
        std::string failure;
    };
    /// By the tracer's.
    struct Traced {
        ModelTruth found;
        std::shared_ptr<const ModelMap> map;  ///< in its place
        double seconds = 0.0;
        std::string failure;  ///< if not empty, there is nothing else
    };
    struct Engines;
    void start_making(Making making);
    void solve_or_make();
    void start_solve();
    void start_reference();
    Scene scene_to_write(const std::filesystem::path& path) const;
    void save_map(const std::filesystem::path& path, const std::string& mark) const;
    void measure();

    SessionSettings settings_;
    std::uint32_t reference_rays_ = 0;
    std::optional<Making> making_;
    bool was_cancelled_ = false;
    bool has_other_pose_ = false;    ///< since the last update()
    bool has_other_bodies_ = false;  ///< likewise
    SessionState state_;
    std::shared_ptr<const Scene> scene_;  ///< of the file that is open, as it was read
    ModelTruth truth_;                    ///< but its reference, which is in state_
    SessionSettings solved_with_;         ///< the answer, a draft's where it is one
    std::vector<Occlusion> occlusion_, at_points_;

    std::unique_ptr<Engines> engines_;  ///< used by the solver's thread alone

    // written by the background threads, taken by update()
    Mailbox<Solved> solved_;
    Mailbox<Traced> traced_;

    BackgroundWorker solver_, tracer_;  // last: their threads write to the above
};

}  // namespace surfelao
