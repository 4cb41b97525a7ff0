#include "viewer/moving_session.h"

#include "surfels/errors.h"
#include "surfels/stopwatch.h"
#include "viewer/solve_model.h"

#include <algorithm>
#include <exception>
#include <span>
#include <utility>

namespace surfelao {
namespace {

std::vector<Receiver> with_ground(std::span<const Receiver> receivers, const Model& base)
{
    std::vector<Receiver> all(receivers.begin(), receivers.end());
    all.insert(all.end(), base.ground_receivers.begin(), base.ground_receivers.end());
    return all;
}

/// The receivers of a target and of the ground, with a memory.
class Asked {
public:
    Asked(const MovingScene& scene, const Model& base, const VertexTarget& target,
          const Bodies& bodies, const SolveSettings& settings)
        : base_(base), target_(target), bodies_(bodies_of_receivers(base, target, bodies))
    {
        bodies_.resize(target.receivers().size() + base.ground_receivers.size(), 0);
        MovingSettings moving;
        static_cast<SolveSettings&>(moving) = settings;
        receivers_.emplace(scene, with_ground(target.receivers(), base), bodies_, moving);
    }

    std::size_t count() const { return bodies_.size(); }

    void deform(const ModelPose& pose)
    {
        const auto is_deformed = [](const BodyPose& body) {
            return body.state == BodyState::deformed;
        };
        if (std::ranges::none_of(pose.bodies, is_deformed))
            return;
        const std::vector<Receiver> all = receivers_on(base_, target_, pose.shape);
        for (std::uint32_t body = 1; body < pose.bodies.size(); ++body) {
            if (!is_deformed(pose.bodies[body]))
                continue;
            std::vector<Receiver> own;
            for (std::size_t i = 0; i < all.size(); ++i) {
                if (bodies_[i] == body)
                    own.push_back(all[i]);
            }
            receivers_->deform(body, own);
        }
    }

    FrameReport solve(const Progress& progress) { return receivers_->solve(progress); }

    /// Model::answer_count()
    std::vector<Occlusion> values() const
    {
        const std::span<const Occlusion> answers = receivers_->occlusion();
        const std::size_t asked = target_.receivers().size();
        std::vector<Occlusion> values = target_.values_locally(answers.first(asked));
        const auto ground = answers.subspan(asked);
        values.insert(values.end(), ground.begin(), ground.end());
        return values;
    }

private:
    const Model& base_;
    const VertexTarget& target_;
    std::vector<std::uint32_t> bodies_;
    std::optional<MovingReceivers> receivers_;
};

TargetSettings at_points_of(TargetSettings settings)
{
    settings.values = VertexValues::point;
    return settings;
}

}  // namespace

/// Of one question.
struct MovingSession::Built {
    Built(std::uint64_t of, const MovingQuestion& asked)
        : number(of),
          question(asked),
          base(*question.base),
          bodies(std::make_shared<const Bodies>(
              bodies_of(base, *question.movables, question.moved, question.motion.get()))),
          scene(base.geometry(), bodies->of_triangle, choice_of(question.engine)),
          rough_target(base.mesh, at_points_of(base.settings)),
          rough(scene, base, rough_target, *bodies, draft_of(question.engine))
    {
    }

    static EngineChoice choice_of(EngineChoice choice)
    {
        choice.device = Device::cpu;
        choice.context = nullptr;
        return choice;
    }

    /// Brings the scene to a pose.
    void place(const MovingPose& pose)
    {
        Stopwatch watch;
        const std::vector<PartPose> parts =
            question.motion ? question.motion->at(pose.seconds) : std::vector<PartPose>();
        now = pose_of(base, *bodies, *question.movables, question.moved, pose.moves, parts);
        pose_s = watch.lap();
        for (std::uint32_t body = 1; body < now.bodies.size(); ++body) {
            const BodyPose& wanted = now.bodies[body];
            if (body < placed.size() && wanted == placed[body] &&
                wanted.state != BodyState::deformed)
                continue;
            switch (wanted.state) {
                case BodyState::placed:
                    scene.place(body, wanted.placement);
                    break;
                case BodyState::gone:
                    scene.hide(body);
                    break;
                case BodyState::deformed:
                    scene.deform(body, now.shape.positions);
                    break;
            }
        }
        placed = now.bodies;
        at = pose;
        rough_frame.reset();
    }

    /// Of the pose at hand.
    FrameReport solve_roughly(const Progress& progress)
    {
        rough.deform(now);
        const FrameReport report = rough.solve(progress);
        rough_values = rough.values();
        return report;
    }

    void make_rough_frame(const Progress& progress)
    {
        MovingFrame frame;
        frame.report = solve_roughly(progress);
        frame.pose = *at;
        frame.shape = now.shape;
        frame.bodies =
            std::make_shared<const PosedBodies>(PosedBodies{question.base, bodies, now.bodies});
        frame.middles = now.middles;
        frame.pose_s = pose_s;
        frame.receivers = rough.count();
        frame.values = rough_values;
        keep_untouched(frame.values);
        rough_frame = std::move(frame);
    }

    bool is_at_rest() const
    {
        return std::ranges::all_of(now.bodies,
                                   [](const BodyPose& body) { return body == BodyPose{}; });
    }

    /// What rests, as it is asked for.
    void settle(MovingFrame& frame, const Progress& progress)
    {
        if (is_at_rest()) {
            frame.posed = question.base;
            return;
        }
        if (!question.solves_whole) {
            frame.posed = std::make_shared<const Model>(posed_model(base, *bodies, now));
            return;
        }
        if (!whole)
            whole.emplace(scene, base, *base.target, *bodies, question.engine);
        whole->deform(now);
        frame.report = whole->solve(progress);
        frame.receivers = whole->count();
        frame.values = whole->values();
        keep_untouched(frame.values);
        remember(frame.values);
        frame.posed = std::make_shared<const Model>(posed_model(base, *bodies, now));
        frame.at_points =
            scene.solve(frame.posed->point_receivers, question.engine, progress).occlusion;
        frame.is_whole = true;
    }

    /// values: of the pose at hand, which was solved roughly.
    void keep_untouched(std::vector<Occlusion>& values) const
    {
        for (std::size_t i = 0; i < well_values.size(); ++i) {
            if (rough_values[i] == rough_then[i])
                values[i] = well_values[i];
        }
    }

    /// values: good ones of the pose at hand, which was solved roughly.
    void remember(const std::vector<Occlusion>& values)
    {
        well_values = values;
        rough_then = rough_values;
    }

    std::uint64_t number;
    const MovingQuestion question;
    const Model& base;
    std::shared_ptr<const Bodies> bodies;
    MovingScene scene;
    VertexTarget rough_target;
    Asked rough;
    std::optional<Asked> whole;  ///< made when something first rests

    std::optional<MovingPose> at;
    ModelPose now;
    std::vector<BodyPose> placed;
    double pose_s = 0.0;
    std::optional<MovingFrame> rough_frame;  ///< of `at`
    std::vector<Occlusion> rough_values;
    std::vector<Occlusion> well_values, rough_then;  ///< of the last pose that was solved well
};

MovingSession::MovingSession() : worker_([this] { built_.reset(); })
{
}
MovingSession::~MovingSession() = default;

void MovingSession::ask(const MovingQuestion& question, std::optional<KnownAnswer> known)
{
    if (question == question_)
        return;
    SURFELAO_CHECK(question.base && !question.base->cloud && !question.base->mesh->occluders);
    question_ = question;
    known_ = std::move(known);
    const std::lock_guard lock(mutex_);
    begin_anew();
    start_if_idle();
}

void MovingSession::forget()
{
    question_ = {};
    known_.reset();
    frame_.reset();
    message_.clear();
    const std::lock_guard lock(mutex_);
    begin_anew();
    worker_.start([this](const Progress&) { built_.reset(); });
}

/// Nothing of the last question comes any more, not even what was found and not taken over.
/// mutex_ is held.
void MovingSession::begin_anew()
{
    ++number_;
    wanted_.reset();
    found_.reset();
    failure_.clear();
    is_running_ = false;
}

void MovingSession::pose(const MovingPose& pose, bool rests)
{
    const std::lock_guard lock(mutex_);
    wanted_ = Wanted{pose, rests};
    start_if_idle();
}

/// mutex_ is held.
void MovingSession::start_if_idle()
{
    if (is_running_)
        return;
    is_running_ = true;
    worker_.start([this, number = number_, question = question_, known = known_](
                      const Progress& progress) { run(number, question, known, progress); });
}

bool MovingSession::has_newer() const
{
    const std::lock_guard lock(mutex_);
    return wanted_.has_value();
}

bool MovingSession::solving() const
{
    return worker_.busy();
}

void MovingSession::run(std::uint64_t number, const MovingQuestion& question,
                        const std::optional<KnownAnswer>& known, const Progress& progress)
{
    for (;;) {
        try {
            build(number, question, known, progress);
            std::optional<Wanted> wanted;
            {
                const std::lock_guard lock(mutex_);
                if (number != number_)
                    return;
                wanted = std::exchange(wanted_, std::nullopt);
                if (!wanted) {
                    is_running_ = false;
                    return;
                }
            }
            answer(number, *wanted, progress);
        } catch (const Cancelled&) {
            if (!progress(0.0))  // not for a newer pose alone
                throw;
        } catch (const std::exception& error) {
            built_.reset();
            const std::lock_guard lock(mutex_);
            if (number == number_) {
                failure_ = error.what();
                is_running_ = false;
            }
            return;
        }
    }
}

void MovingSession::build(std::uint64_t number, const MovingQuestion& question,
                          const std::optional<KnownAnswer>& known, const Progress& progress)
{
    if (built_ && built_->number == number)
        return;
    built_.reset();  // before the next one is built: both may be large
    auto built = std::make_unique<Built>(number, question);
    if (known) {
        built->place(known->pose);
        static_cast<void>(built->solve_roughly(progress));
        built->remember(known->values);
    }
    built_ = std::move(built);
}

void MovingSession::answer(std::uint64_t number, const Wanted& wanted, const Progress& progress)
{
    Built& built = *built_;
    if (!built.rough_frame || built.at != wanted.pose) {
        built.place(wanted.pose);
        built.make_rough_frame(progress);
        post(number, *built.rough_frame);
    }
    if (!wanted.rests)
        return;
    MovingFrame frame = *built.rough_frame;
    built.settle(frame, [&](double done) { return progress(done) && !has_newer(); });
    post(number, frame);
}

void MovingSession::post(std::uint64_t number, const MovingFrame& frame)
{
    auto copy = std::make_shared<const MovingFrame>(frame);
    const std::lock_guard lock(mutex_);
    if (number == number_)
        found_ = std::move(copy);
}

bool MovingSession::update()
{
    const std::lock_guard lock(mutex_);
    if (!failure_.empty())
        message_ = std::exchange(failure_, {});
    if (!found_)
        return false;
    frame_ = std::move(found_);
    message_.clear();
    return true;
}

}  // namespace surfelao
