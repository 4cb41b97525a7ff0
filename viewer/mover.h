/// mover.h: what a user moves in a session's model, by hand and by playing an animation. Knows no
/// window.
///
///     session (file, settings) --base--> MovingSession --frames--> shown while something moves
///        ^                                    |
///        +------ the model by itself ---------+ once it rests: Session::take_pose()
#pragma once

#include "files/motion.h"
#include "files/scene_io.h"
#include "viewer/background_worker.h"
#include "viewer/mailbox.h"
#include "viewer/model_pose.h"
#include "viewer/movables.h"
#include "viewer/moving_session.h"
#include "viewer/player.h"
#include "viewer/session.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {

/// For one thread, the session's.
class Mover {
public:
    Mover() = default;

    /// Of the file that is opened next: the moment that it is read at, whose animation is chosen
    /// then, and held there.
    void begin_at(const std::optional<Moment>& moment) { begin_ = moment; }

    /// Once a frame, behind Session::update(). is_other_file: its Changes::file. now: seconds on
    /// the wall, rising. True where shown() is another frame than before.
    bool update(Session& session, bool is_other_file, double now);

    /// While something moves and until the session has it: what is to be shown in place of the
    /// session's model. Null: nothing is.
    const std::shared_ptr<const MovingFrame>& shown() const { return shown_; }
    /// What frames are of. Null until there is a model.
    const std::shared_ptr<const Model>& base() const { return base_; }
    /// Something is played, found, or on its way.
    bool is_busy() const { return player_.is_playing || loader_.busy() || moving_.solving(); }

    /// Null until they were found.
    const Movables* movables() const { return movables_.get(); }
    /// Why nothing of this model can be moved; empty where it can.
    const std::string& refusal() const { return refusal_; }
    /// What went wrong; else empty.
    const std::string& message() const
    {
        return moving_.message().empty() ? message_ : moving_.message();
    }

    const std::optional<std::uint32_t>& selected() const { return selected_; }
    /// A movable, or nothing.
    void select(std::optional<std::uint32_t> movable);
    /// That of a scene vertex, if it is one.
    void select_vertex(std::uint32_t vertex);

    [[nodiscard]] PartMove move_of(std::uint32_t movable) const;
    void set_move(std::uint32_t movable, const PartMove& move);
    /// Where the animation has it, without the move.
    [[nodiscard]] glm::dvec3 middle_of(std::uint32_t movable) const;
    [[nodiscard]] bool is_moved() const;  ///< any of them

    /// While the mouse holds something, nothing rests.
    void hold(bool is_held) { is_held_ = is_held; }
    /// Before a change: undo() comes back to here.
    void remember();
    void undo();  ///< of moves alone
    [[nodiscard]] bool can_undo() const;
    void reset_all();

    /// "" where one has no name.
    const std::vector<std::string>& animations() const { return animations_; }
    const std::optional<std::size_t>& chosen() const { return chosen_; }
    /// Read in the background, then shown from its first key on. Nothing: the pose of the file.
    void choose(std::optional<std::size_t> animation);
    Player& player() { return player_; }
    bool is_ready() const { return motion_ != nullptr; }  ///< the animation that is chosen

    /// The last frame, for its figures; null where there was none.
    const MovingFrame* last_frame() const { return moving_.frame().get(); }
    double frames_per_second() const { return rate_; }  ///< that were solved; 0 at rest

private:
    /// What the loader finds.
    struct Found {
        std::shared_ptr<const Movables> movables;
        std::shared_ptr<const Motion> motion;
        std::shared_ptr<const PosedBodies> begun;  ///< where the file was read at a moment of it
        std::string failure;
    };
    /// A pose that the session's model is in.
    struct Taken {
        MovingPose pose;
        std::shared_ptr<const Motion> motion;
    };

    void take_base(const Session& session, bool is_other_file);
    void load();
    void take_found(Session& session);
    void take_motion(std::shared_ptr<const Motion> motion);
    [[nodiscard]] std::string animation_name() const;
    [[nodiscard]] MovingPose wanted_pose() const;
    [[nodiscard]] bool has_pose(const Taken& taken, const MovingPose& pose) const;
    [[nodiscard]] MovingQuestion question_of(const Session& session) const;
    void ask(Session& session, const MovingPose& pose, bool is_there);
    bool take_frame(Session& session, const MovingPose& pose, bool rests, double now);
    [[nodiscard]] std::uint32_t touch(std::uint32_t movable);

    std::shared_ptr<const Model> base_;
    std::shared_ptr<const Model> posed_;  ///< that the session was given
    std::shared_ptr<const Movables> movables_;
    std::string refusal_, message_;
    std::optional<Moment> begin_;

    std::optional<std::uint32_t> selected_;
    std::vector<std::uint32_t> touched_;  ///< movables that are bodies
    std::vector<PartMove> moves_;         ///< of them
    std::vector<std::vector<PartMove>> undo_;
    bool is_held_ = false;

    std::vector<std::string> animations_;
    std::optional<std::size_t> chosen_;
    std::shared_ptr<const Motion> motion_;
    Player player_;
    double now_ = 0.0;

    Taken taken_;
    std::optional<MovingQuestion> asked_;
    std::optional<std::pair<MovingPose, bool>> requested_;
    std::shared_ptr<const MovingFrame> shown_;
    double last_frame_at_ = 0.0, rate_ = 0.0;

    Mailbox<Found> found_;
    MovingSession moving_;
    BackgroundWorker loader_;  // last: its thread writes to the above
};

}  // namespace surfelao
