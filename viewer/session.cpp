#include "viewer/session.h"

#include "files/scene_io.h"
#include "reference/reference_cache.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace surfelao {
namespace {

constexpr int kDraftShare = 16;  // of the rays

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The rough answer's settings; the same ones where the engine has none rougher.
SessionSettings draft_of(SessionSettings settings, const EngineTraits& traits)
{
    if (traits.most_quality > 0.0f)
        settings.quality = std::min(settings.quality, 0.0f);
    if (traits.has_rays)
        settings.rays = std::max(1, settings.rays / kDraftShare);
    return settings;
}

}  // namespace

struct Session::Read {
    std::uint64_t number = 0;
    std::string failure;  ///< if not empty, the rest is
    std::filesystem::path path;
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const Model> model;
    double seconds = 0.0;
};

struct Session::Answer {
    std::uint64_t number = 0;
    Solved solved;
    bool is_draft = false;
};

struct Session::Traced {
    std::uint64_t number = 0;
    Reference reference;
    double seconds = 0.0;
};

Definition definition_of(const SessionSettings& settings)
{
    Definition definition;
    if (settings.max_distance_percent > 0.0f) {
        definition.max_distance = settings.max_distance_percent / 100.0f;
        definition.falloff = settings.smooth_falloff ? Falloff::smooth : Falloff::none;
    }
    return definition;
}

Session::Session(Services services) : services_(std::move(services))
{
}
Session::~Session() = default;

void Session::open(const std::filesystem::path& path, UpAxis up)
{
    state_.message.clear();
    opening_ = true;
    const std::uint64_t number = ++solve_number_;
    solver_.start([this, number, path, up](const Progress&) {
        const auto start = std::chrono::steady_clock::now();
        auto read = std::make_unique<Read>();
        read->number = number;
        read->path = path;
        try {
            read->scene = std::make_shared<const Scene>(read_scene(path));
            read->model = std::make_shared<const Model>(
                make_model(make_geometry(*read->scene), up, Definition().offset));
        } catch (const std::exception& error) {
            read->failure = error.what();
        }
        read->seconds = seconds_since(start);
        const std::lock_guard lock(mailbox_);
        read_ = std::move(read);
    });
}

void Session::solve(const SessionSettings& settings)
{
    if (settings == settings_)
        return;
    const bool other_question = settings.max_distance_percent != settings_.max_distance_percent ||
                                settings.smooth_falloff != settings_.smooth_falloff;
    settings_ = settings;
    if (!state_.model || opening_)
        return;  // the next model is solved with them
    if (other_question)
        start_reference();
    start_solve();
}

void Session::start_solve()
{
    was_cancelled_ = false;
    const std::uint64_t number = ++solve_number_;
    const EngineTraits& traits = services_.engines[settings_.engine];
    std::vector<SessionSettings> steps = {draft_of(settings_, traits), settings_};
    if (steps[0] == steps[1])
        steps.pop_back();
    solver_.start([this, number, steps, model = state_.model](const Progress& progress) {
        try {
            for (std::size_t i = 0; i < steps.size(); ++i) {
                auto answer = std::make_unique<Answer>();
                answer->number = number;
                answer->is_draft = i + 1 < steps.size();
                answer->solved = services_.solve(*model, steps[i], progress);
                const std::lock_guard lock(mailbox_);
                answer_ = std::move(answer);
            }
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            const std::lock_guard lock(mailbox_);
            failure_ = error.what();
        }
    });
}

void Session::want_reference(std::uint32_t rays)
{
    if (rays == reference_rays_)
        return;
    reference_rays_ = rays;
    if (state_.model)
        start_reference();
}

void Session::start_reference()
{
    const std::uint64_t number = ++trace_number_;
    state_.reference.clear();
    state_.error.reset();
    if (reference_rays_ == 0) {
        tracer_.cancel();
        return;
    }
    const ReferenceOptions options{definition_of(settings_), reference_rays_};
    tracer_.start([this, number, options, model = state_.model](const Progress& progress) {
        try {
            const auto start = std::chrono::steady_clock::now();
            auto traced = std::make_unique<Traced>();
            traced->number = number;
            traced->reference =
                trace_reference(model->geometry, model->receivers, options, progress);
            traced->seconds = seconds_since(start);
            const std::lock_guard lock(mailbox_);
            traced_ = std::move(traced);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            const std::lock_guard lock(mailbox_);
            failure_ = error.what();
        }
    });
}

void Session::solve_again()
{
    if (state_.model && !opening_)
        start_solve();
}

void Session::cancel()
{
    was_cancelled_ = solver_.busy();
    opening_ = false;
    solver_.cancel();
    tracer_.cancel();
}

/// Over the vertices that have a normal and an answer.
void Session::measure()
{
    state_.error.reset();
    if (state_.reference.empty() || state_.occlusion.empty())
        return;
    std::vector<Occlusion> answer, reference;
    for (std::size_t v = 0; v < has_answer_.size(); ++v) {
        if (has_answer_[v]) {
            answer.push_back(state_.occlusion[v]);
            reference.push_back(state_.reference[v]);
        }
    }
    state_.error = services_.measure(answer, reference);
}

Session::Changes Session::update()
{
    std::unique_ptr<Read> read;
    std::unique_ptr<Answer> answer;
    std::unique_ptr<Traced> traced;
    {
        const std::lock_guard lock(mailbox_);
        read = std::move(read_);
        answer = std::move(answer_);
        traced = std::move(traced_);
        if (!failure_.empty())
            state_.message = std::exchange(failure_, {});
    }
    Changes changes;
    if (read && read->number == solve_number_ && opening_) {
        opening_ = false;
        state_.message = read->failure;
        changes.model = read->failure.empty();
    }
    if (changes.model) {
        state_.path = read->path;
        state_.scene = read->scene;
        state_.model = read->model;
        state_.read_s = read->seconds;
        state_.occlusion.clear();
        start_reference();
        start_solve();
    }
    if (answer && answer->number == solve_number_) {
        state_.occlusion = std::move(answer->solved.occlusion);
        state_.is_draft = answer->is_draft;
        was_cancelled_ = was_cancelled_ && answer->is_draft;
        state_.build_s = answer->solved.build_s;
        state_.solve_s = answer->solved.solve_s;
        state_.message.clear();
        changes.occlusion = true;
    }
    if (traced && traced->number == trace_number_) {
        const Geometry& geometry = state_.model->geometry;
        has_answer_.assign(geometry.positions.size(), false);
        for (std::size_t v = 0; v < has_answer_.size(); ++v)
            has_answer_[v] =
                geometry.normals[v] != glm::vec3(0.0f) && traced->reference.well_defined(v);
        state_.reference = std::move(traced->reference.occlusion);
        state_.reference_s = traced->seconds;
        changes.reference = true;
    }
    if (changes.occlusion || changes.reference)
        measure();
    return changes;
}

}  // namespace surfelao
