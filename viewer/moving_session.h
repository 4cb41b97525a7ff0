/// moving_session.h: a model whose parts move, solved in the background: each pose roughly at once,
/// a pose that rests as it is asked for. Knows no window.
///
/// A pose is solved to its end unless another question comes; what is wanted next is the newest
/// pose by then, so that a slow engine shows fewer poses and none of them late. A frame is handed
/// over whole: shape and values are of one pose.
///
/// Vertices whose rough answer is what it was at the last pose that was solved well keep that
/// pose's values, to the bit, roughly or well: what nothing touches does not change its look.
#pragma once

#include "engines/moving.h"
#include "files/motion.h"
#include "surfels/occlusion.h"
#include "viewer/background_worker.h"
#include "viewer/model.h"
#include "viewer/model_pose.h"
#include "viewer/movables.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// What may move, and who answers.
struct MovingQuestion {
    std::shared_ptr<const Model> base;  ///< a mesh's in which all that is shown occludes
    std::shared_ptr<const Movables> movables;
    std::vector<std::uint32_t> moved;      ///< of them, those that a hand moves
    std::shared_ptr<const Motion> motion;  ///< null: none is played
    EngineSettings engine;                 ///< with the definition; it runs on the CPU
    bool solves_whole = true;  ///< else a pose that rests is left to whoever takes its model
    bool operator==(const MovingQuestion&) const = default;
};

struct MovingPose {
    std::vector<PartMove> moves;  ///< one per MovingQuestion::moved
    double seconds = 0.0;         ///< of the motion, if any
    bool operator==(const MovingPose&) const = default;
};

/// Values that are known already, of the question's settings.
struct KnownAnswer {
    MovingPose pose;
    std::vector<Occlusion> values;  ///< Model::answer_count()
};

struct MovingFrame {
    MovingPose pose;
    ModelShape shape;
    std::shared_ptr<const PosedBodies> bodies;  ///< whose pose it is
    std::vector<glm::dvec3> middles;            ///< ModelPose::middles
    std::vector<Occlusion> values;              ///< Model::answer_count() of the base
    bool is_whole = false;      ///< values are of the question's settings, not rough
    double pose_s = 0.0;        ///< of the shape
    FrameReport report;         ///< of the rough answer, or of the whole one
    std::size_t receivers = 0;  ///< that were asked
    /// Of a pose that rests: the model by itself, the base where nothing is off its place.
    std::shared_ptr<const Model> posed;
    std::vector<Occlusion> at_points;  ///< is_whole: one per posed->points
};

/// For one thread; update() takes over what the background thread has finished.
class MovingSession {
public:
    MovingSession();
    ~MovingSession();

    /// Other parts, another engine or base. What runs is given up, and what the engine builds is
    /// begun. Does nothing when it is the last question. known: of the same base and motion.
    void ask(const MovingQuestion& question, std::optional<KnownAnswer> known = {});

    /// The pose that is wanted now, of the question. rests: it is to be solved well, too, unless
    /// another one comes meanwhile.
    void pose(const MovingPose& pose, bool rests);

    /// Gives up what runs, and forgets the question with all that was built for it.
    void forget();

    /// Whether there is another frame than at the last call.
    [[nodiscard]] bool update();
    /// The last one; null until there is one.
    const std::shared_ptr<const MovingFrame>& frame() const { return frame_; }

    bool solving() const;
    const std::string& message() const { return message_; }  ///< what went wrong; else empty

private:
    struct Wanted {
        MovingPose pose;
        bool rests = false;
    };
    struct Built;
    void begin_anew();
    void start_if_idle();
    void run(std::uint64_t number, const MovingQuestion& question,
             const std::optional<KnownAnswer>& known, const Progress& progress);
    void build(std::uint64_t number, const MovingQuestion& question,
               const std::optional<KnownAnswer>& known, const Progress& progress);
    void answer(std::uint64_t number, const Wanted& wanted, const Progress& progress);
    void post(std::uint64_t number, const MovingFrame& frame);
    bool has_newer() const;

    MovingQuestion question_;
    std::optional<KnownAnswer> known_;
    std::shared_ptr<const MovingFrame> frame_;
    std::string message_;
    std::unique_ptr<Built> built_;  ///< used by the background thread alone

    mutable std::mutex mutex_;  ///< of what follows
    std::uint64_t number_ = 0;  ///< of the question; frames of others are dropped
    std::optional<Wanted> wanted_;
    bool is_running_ = false;  ///< and will look for another pose before it ends
    std::shared_ptr<const MovingFrame> found_;
    std::string failure_;

    BackgroundWorker worker_;  // last: its thread writes to the above
};

}  // namespace surfelao
