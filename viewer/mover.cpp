#include "viewer/mover.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace surfelao {
namespace {

constexpr std::size_t kMostUndo = 100;  // a few kilobytes
/// Of the last frame's rate in the one that is told: its digits can be read.
constexpr double kRateShare = 0.2;
constexpr double kPause = 0.5;  // seconds: frames farther apart are no sequence

std::string refusal_of(const Model& model)
{
    if (model.cloud)
        return "points are not moved";
    if (model.mesh->occluders || !model.mesh->unbaked.empty())
        return "nothing is moved where parts are left out, other files occlude, or materials have "
               "holes";
    return {};
}

}  // namespace

void Mover::take_base(const Session& session, bool is_other_file)
{
    const std::shared_ptr<const Model>& model = session.state().model;
    if (model == base_ || model == posed_)
        return;
    base_ = model;
    posed_.reset();
    movables_.reset();
    refusal_ = refusal_of(*base_);
    taken_ = {};
    shown_.reset();
    asked_.reset();
    requested_.reset();
    moving_.forget();
    if (is_other_file) {
        selected_.reset();
        touched_.clear();
        moves_.clear();
        undo_.clear();
        motion_.reset();
        chosen_.reset();
        player_ = {};
        animations_ =
            refusal_.empty() ? animations_of(base_->mesh->scene) : std::vector<std::string>();
        if (begin_ && !animations_.empty()) {
            const auto named = std::ranges::find(animations_, begin_->animation);
            chosen_ = 0;
            if (named != animations_.end())
                chosen_ = static_cast<std::size_t>(named - animations_.begin());
            else if (!begin_->animation.empty())
                chosen_ = std::stoul(begin_->animation);  // a number, or it was not read
        } else {
            begin_.reset();
        }
    }
    if (refusal_.empty())
        load();
}

void Mover::load()
{
    message_.clear();
    loader_.start([this, number = found_.ask(), base = base_, movables = movables_,
                   animation = chosen_ && !motion_ ? std::optional(animation_name()) : std::nullopt,
                   begins = begin_.has_value()](const Progress&) {
        Found found;
        found.movables = movables;
        try {
            if (!movables)
                found.movables = std::make_shared<const Movables>(movables_of(*base->mesh));
            if (animation)
                found.motion = std::make_shared<const Motion>(base->mesh->scene, *animation);
            if (found.motion && begins)
                found.begun = std::make_shared<const PosedBodies>(
                    bodies_at_rest(base, std::make_shared<const Bodies>(bodies_of(
                                             *base, *found.movables, {}, found.motion.get()))));
        } catch (const std::exception& error) {
            found.failure = error.what();
        }
        found_.post(number, std::move(found));
    });
}

std::string Mover::animation_name() const
{
    const std::string& name = animations_[*chosen_];
    return name.empty() ? std::to_string(*chosen_) : name;
}

void Mover::take_found(Session& session)
{
    const std::optional<Found> found = found_.take();
    if (!found)
        return;
    message_ = found->failure;
    if (!found->failure.empty())
        chosen_.reset();
    movables_ = found->movables;
    if (movables_ && !touched_.empty() && std::ranges::max(touched_) >= movables_->list.size()) {
        touched_.clear();
        moves_.clear();
        undo_.clear();
    }
    if (selected_ && (!movables_ || *selected_ >= movables_->list.size()))
        selected_.reset();
    if (found->begun && begin_)
        session.take_bodies(found->begun);
    if (found->motion)
        take_motion(found->motion);
}

void Mover::take_motion(std::shared_ptr<const Motion> motion)
{
    motion_ = std::move(motion);
    player_.first = motion_->first_seconds();
    player_.last = motion_->last_seconds();
    player_.seek(begin_ ? begin_->seconds : player_.first);
    player_.is_playing = false;
    if (begin_)  // the file was read there
        taken_ = {{{}, player_.seconds}, motion_};
    begin_.reset();
}

void Mover::choose(std::optional<std::size_t> animation)
{
    if (animation == chosen_)
        return;
    chosen_ = animation;
    begin_.reset();  // it was of the animation that the file was read with
    motion_.reset();
    player_.is_playing = false;
    if (chosen_)
        load();
}

void Mover::select(std::optional<std::uint32_t> movable)
{
    selected_ = movable;
    if (movable)
        static_cast<void>(touch(*movable));
}

void Mover::select_vertex(std::uint32_t vertex)
{
    if (movables_ && movables_->of_vertex[vertex] != Movables::kNone)
        select(movables_->of_vertex[vertex]);
}

std::uint32_t Mover::touch(std::uint32_t movable)
{
    const auto found = std::ranges::find(touched_, movable);
    if (found != touched_.end())
        return static_cast<std::uint32_t>(found - touched_.begin());
    touched_.push_back(movable);
    moves_.emplace_back();
    return static_cast<std::uint32_t>(touched_.size() - 1);
}

PartMove Mover::move_of(std::uint32_t movable) const
{
    const auto found = std::ranges::find(touched_, movable);
    return found == touched_.end() ? PartMove{}
                                   : moves_[static_cast<std::size_t>(found - touched_.begin())];
}

void Mover::set_move(std::uint32_t movable, const PartMove& move)
{
    const std::uint32_t index = touch(movable);
    moves_[index] = move;
}

glm::dvec3 Mover::middle_of(std::uint32_t movable) const
{
    const auto found = std::ranges::find(touched_, movable);
    const auto index = static_cast<std::size_t>(found - touched_.begin());
    const std::shared_ptr<const MovingFrame>& frame = moving_.frame();
    if (motion_ && frame && index < frame->middles.size())
        return frame->middles[index];
    return movables_->list[movable].middle();
}

bool Mover::is_moved() const
{
    return std::ranges::any_of(moves_, [](const PartMove& move) { return move != PartMove{}; });
}

void Mover::remember()
{
    if (!undo_.empty() && undo_.back() == moves_)
        return;
    undo_.push_back(moves_);
    if (undo_.size() > kMostUndo)
        undo_.erase(undo_.begin());
}

bool Mover::can_undo() const
{
    return std::ranges::any_of(undo_, [&](const std::vector<PartMove>& moves) {
        return !std::equal(moves.begin(), moves.end(), moves_.begin()) ||
               std::any_of(moves_.begin() + static_cast<std::ptrdiff_t>(moves.size()), moves_.end(),
                           [](const PartMove& move) { return move != PartMove{}; });
    });
}

void Mover::undo()
{
    while (!undo_.empty()) {
        std::vector<PartMove> before = std::move(undo_.back());
        undo_.pop_back();
        before.resize(moves_.size());  // what was touched since had not moved
        if (before != moves_) {
            moves_ = std::move(before);
            return;
        }
    }
}

void Mover::reset_all()
{
    remember();
    std::ranges::fill(moves_, PartMove{});
}

MovingPose Mover::wanted_pose() const
{
    return {moves_, motion_ ? player_.seconds : 0.0};
}

bool Mover::has_pose(const Taken& taken, const MovingPose& pose) const
{
    MovingPose had = taken.pose;
    had.moves.resize(pose.moves.size());
    return taken.motion == motion_ && had == pose;
}

MovingQuestion Mover::question_of(const Session& session) const
{
    const SessionSettings& settings = session.settings();
    EngineSettings engine = settings.engine;
    engine.definition = session.definition();
    const bool at_vertices = !settings.texels && engine.device == Device::cpu;
    engine.device = Device::cpu;
    engine.context = nullptr;
    return {base_, movables_, touched_, motion_, engine, at_vertices};
}

/// is_there: the session's model is in this pose.
void Mover::ask(Session& session, const MovingPose& pose, bool is_there)
{
    MovingQuestion question = question_of(session);
    if (asked_ == question)
        return;
    const SessionState& state = session.state();
    const bool is_known = is_there && state.is_solved && !state.is_draft && !state.layout;
    // until something moves its values may still come, and are of use then
    if (is_there && !is_known && session.solving())
        return;
    std::optional<KnownAnswer> known;
    if (is_known && question.solves_whole)
        known = KnownAnswer{pose, session.occlusion()};
    moving_.ask(question, std::move(known));
    asked_ = std::move(question);
    requested_.reset();
}

bool Mover::update(Session& session, bool is_other_file, double now)
{
    const double elapsed = std::max(0.0, now - std::exchange(now_, now));
    if (!session.state().model)
        return false;
    take_base(session, is_other_file);
    take_found(session);
    player_.advance(elapsed);
    const bool was_moved = shown_ || !has_pose(taken_, {});
    if (!movables_ || session.making() || (!motion_ && touched_.empty() && !was_moved))
        return false;
    const MovingPose pose = wanted_pose();
    const bool is_there = !shown_ && has_pose(taken_, pose);
    const bool rests = !is_held_ && !player_.is_playing;
    ask(session, pose, is_there);
    const std::pair wanted{pose, rests};
    if (asked_ && !is_there && requested_ != wanted) {
        if (session.solving() || session.tracing())
            session.give_up();
        moving_.pose(pose, rests);
        requested_ = wanted;
    }
    return take_frame(session, pose, rests, now);
}

bool Mover::take_frame(Session& session, const MovingPose& pose, bool rests, double now)
{
    if (now - last_frame_at_ > kPause)
        rate_ = 0.0;
    if (!moving_.update())
        return false;
    const std::shared_ptr<const MovingFrame>& frame = moving_.frame();
    const double between = now - std::exchange(last_frame_at_, now);
    if (between > 0.0 && between < kPause)
        rate_ = rate_ > 0.0 ? (1.0 - kRateShare) * rate_ + kRateShare / between : 1.0 / between;
    if (!frame->posed || !rests || frame->pose != pose) {
        shown_ = frame;
        return true;
    }
    PoseName name;
    name.by_hand = is_moved();
    name.bodies = frame->bodies;
    if (motion_)
        name.moment = Moment{pose.seconds, animation_name()};
    const FrameReport& report = frame->report;
    session.take_pose(frame->posed, name,
                      {frame->values, frame->at_points, report.place + report.tree + report.solve},
                      frame->is_whole);
    posed_ = frame->posed;
    taken_ = {pose, motion_};
    shown_.reset();
    return false;
}

}  // namespace surfelao
