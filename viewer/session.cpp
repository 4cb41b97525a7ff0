#include "viewer/session.h"

#include "bake/bake.h"
#include "bake/texel_layout.h"
#include "files/file_type.h"
#include "files/scene_io.h"
#include "gpu/context.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"
#include "viewer/joined_scene.h"

#include <algorithm>
#include <exception>
#include <span>
#include <utility>

namespace surfelao {

namespace {

/// The scene and those of the files beside it as one.
Scene with_files(Scene scene, std::span<const std::filesystem::path> beside,
                 const Progress& progress)
{
    std::vector<Scene> scenes;
    scenes.push_back(std::move(scene));
    for (const std::filesystem::path& path : beside) {
        ReadOptions reading;
        reading.progress = progress;
        scenes.push_back(read_scene(path, reading));
    }
    return joined_scene(scenes);
}

}  // namespace

struct Session::Made {
    std::string failure;  ///< if not empty, the rest is
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const Model> model;
    PoseName pose = {};
    double seconds = 0.0;
};

struct Session::Answer {
    ModelAnswer found;
    std::shared_ptr<const ModelLayout> layout;  // with a map
    std::shared_ptr<const ModelMap> map;
    std::optional<StatedError> map_error;
    std::optional<double> build_s;
    std::shared_ptr<const Prepared> prepared;  // on the CPU
    SessionSettings settings;
    bool is_draft = false;
};

/// The engine at hand and what it was prepared for.
struct Session::Engines {
    std::optional<GlContext> own_context;
    std::shared_ptr<const Model> model;
    std::shared_ptr<const Prepared> prepared;
    std::optional<double> untold_s;  ///< seconds of preparing, until a whole answer has come of it
    std::optional<TexelSettings> texels;        ///< that the layout was made for
    std::shared_ptr<const ModelLayout> layout;  ///< of the model

    const std::shared_ptr<const ModelLayout>& layout_for(const TexelSettings& wanted,
                                                         const Progress& progress)
    {
        if (texels != wanted || !layout) {
            layout.reset();
            layout = std::make_shared<const ModelLayout>(layout_of(*model, wanted, progress));
            texels = wanted;
        }
        return layout;
    }

    /// Where the GPU's engines compute.
    const GlContext* context()
    {
        if (!own_context)
            own_context.emplace(GlContext::create());
        return &*own_context;
    }

    void prepare_for(const std::shared_ptr<const Model>& wanted, const EngineChoice& choice)
    {
        if (model == wanted && prepared && prepared->choice() == choice)
            return;
        prepared.reset();  // before the next one is built: both may be large
        if (model != wanted)
            layout.reset();
        model = wanted;
        prepared = std::make_shared<const Prepared>(surfelao::prepare(*wanted, choice));
        untold_s = prepared->seconds().surfels + prepared->seconds().tree;
    }

    /// In the thread that has used them.
    void end()
    {
        prepared.reset();
        own_context.reset();
    }
};

Session::Session() : engines_(std::make_unique<Engines>()), solver_([this] { engines_->end(); })
{
}
Session::~Session() = default;

void Session::open(const std::filesystem::path& path, UpAxis up, const ReadOptions& reading)
{
    state_.message.clear();
    start_making({path, up, nullptr, settings_.target, settings_.parts, settings_.ground,
                  settings_.beside, reading});
}

void Session::open(const std::filesystem::path& path, UpAxis up, const SessionSettings& settings,
                   const ReadOptions& reading)
{
    settings_ = settings;
    open(path, up, reading);
}

void Session::set_up(UpAxis up)
{
    settings_.target.sky = up_direction(up);
    if (settings_.ground)
        settings_.ground = GroundPlane{up_direction(up)};
    Making anew = making_.value_or(Making{.path = state_.path,
                                          .up = up,
                                          .scene = scene_,
                                          .target = {},
                                          .parts = settings_.parts,
                                          .ground = {},
                                          .beside = settings_.beside});
    anew.up = up;
    anew.target = settings_.target;
    anew.ground = settings_.ground;
    if (making_ || state_.model)
        start_making(std::move(anew));
}

void Session::open(const Session& other, const SessionSettings& settings)
{
    const SessionState& shown = other.state_;
    SURFELAO_CHECK(shown.model);
    settings_ = settings;
    settings_.target = shown.model->settings;
    settings_.parts = shown.parts;
    settings_.beside = shown.beside;
    settings_.ground = shown.model->ground_plane;
    state_.message.clear();
    making_ = Making{.path = shown.path,
                     .up = shown.model->up,
                     .scene = nullptr,
                     .target = settings_.target,
                     .parts = settings_.parts,
                     .ground = settings_.ground,
                     .beside = settings_.beside};
    Solved solved;
    solved.made = std::make_unique<Made>();
    solved.made->scene = other.scene_;
    solved.made->model = shown.model;
    solved.made->pose = shown.pose;
    solver_.cancel();
    solved_.post(solved_.ask(), std::move(solved));
}

void Session::start_making(Making making)
{
    making_ = making;
    solver_.start([this, number = solved_.ask(),
                   making = std::move(making)](const Progress& progress) {
        Stopwatch watch;
        ReadOptions reading = making.reading;
        reading.progress = progress;
        auto made = std::make_unique<Made>();
        try {
            Scene scene = making.scene ? *making.scene : read_scene(making.path, reading);
            // make_mesh splits free vertices, for these normals alone
            if (scene.free_vertices || !making.beside.empty())
                made->scene = making.scene ? making.scene : std::make_shared<const Scene>(scene);
            if (!making.beside.empty())
                scene = with_files(std::move(scene), making.beside, progress);
            const std::vector<Scene> others = read_others(making.parts, {});
            made->model = std::make_shared<const Model>(
                model_of(std::move(scene), making.up, making.target,
                         {.parts = making.parts, .ground = making.ground, .others = others}));
            const std::shared_ptr<const Mesh>& mesh = made->model->mesh;
            if (!made->scene)
                made->scene = std::shared_ptr<const Scene>(mesh, &mesh->scene);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            made->failure = error.what();
        }
        made->seconds = watch.lap();
        Solved solved;
        solved.made = std::move(made);
        solved_.post(number, std::move(solved));
    });
}

void Session::solve(const SessionSettings& settings)
{
    if (settings == settings_)
        return;
    const bool other_question =
        settings.max_distance != settings_.max_distance || settings.texels != settings_.texels;
    settings_ = settings;
    if (making_) {  // its model is solved with them
        if (making_->target != settings_.target || making_->parts != settings_.parts ||
            making_->ground != settings_.ground || making_->beside != settings_.beside) {
            Making anew = *making_;
            anew.target = settings_.target;
            anew.parts = settings_.parts;
            anew.ground = settings_.ground;
            anew.beside = settings_.beside;
            start_making(std::move(anew));
        }
        return;
    }
    if (!state_.model)
        return;
    if (other_question)
        start_reference();
    solve_or_make();
}

/// The model at hand, where it is the one that the settings ask for.
void Session::solve_or_make()
{
    was_cancelled_ = false;
    if (state_.model->settings == settings_.target && state_.parts == settings_.parts &&
        state_.beside == settings_.beside && state_.model->ground_plane == settings_.ground)
        start_solve();
    else
        start_making({state_.path, state_.model->up, scene_, settings_.target, settings_.parts,
                      settings_.ground, settings_.beside});
}

void Session::solve_as(const SessionSettings& settings)
{
    SessionSettings own = settings_;
    own.engine = settings.engine;
    own.max_distance = settings.max_distance;
    own.texels = settings.texels;
    solve(own);
}

Definition Session::definition() const
{
    Definition definition =
        definition_of(settings_.max_distance, Kernel::cosine, state_.model->geometry().frame);
    definition.ground = state_.model->occluding_ground;
    return definition;
}

std::shared_ptr<const Prepared> Session::shared_engine(const EngineChoice& choice) const
{
    const std::shared_ptr<const Prepared>& prepared = state_.prepared;
    const bool is_shared = choice.device != Device::gpu && prepared && prepared->choice() == choice;
    return is_shared ? prepared : nullptr;
}

bool Session::can_be_asked(const EngineChoice& choice) const
{
    if (choice.device == Device::gpu || !state_.pose.is_rest())
        return state_.is_solved && !state_.is_draft;
    return shared_engine(choice) != nullptr;
}

void Session::start_solve()
{
    EngineSettings whole = settings_.engine;
    whole.definition = definition();
    std::vector<EngineSettings> steps = {draft_of(whole), whole};
    if (steps[0] == steps[1])
        steps.pop_back();
    solver_.start([this, number = solved_.ask(), steps, limit = settings_.max_distance,
                   texels = settings_.texels, parts = state_.parts,
                   model = state_.model](const Progress& progress) {
        try {
            EngineChoice choice = steps[0];
            choice.context = choice.device == Device::gpu ? engines_->context() : nullptr;
            engines_->prepare_for(model, choice);
            for (std::size_t i = 0; i < steps.size(); ++i) {
                auto answer = std::make_unique<Answer>();
                answer->is_draft = i + 1 < steps.size();
                answer->build_s = engines_->untold_s;
                if (choice.device == Device::cpu)
                    answer->prepared = engines_->prepared;
                answer->settings = {steps[i], limit, model->settings,    texels,
                                    parts,    {},    model->ground_plane};
                answer->found =
                    solve_model(*engines_->prepared, *model, steps[i],
                                {.vertices = !texels, .ground = true, .points = !texels},
                                // the ground is little beside a map
                                [&](double done) { return progress(texels ? 0.0 : done); });
                if (texels) {
                    EngineSettings engine = steps[i];
                    engine.context = choice.context;
                    answer->layout = engines_->layout_for(*texels, progress);
                    MapAnswer map =
                        solve_map(*model, answer->layout->layout, engine, texels->padding,
                                  answer->is_draft ? 0 : kCheckPoints, progress);
                    answer->map = std::make_shared<const ModelMap>(std::move(map.map));
                    answer->map_error = map.error;
                    answer->found.seconds += map.seconds;
                }
                Solved solved;
                solved.answer = std::move(answer);
                solved_.post(number, std::move(solved));
            }
            engines_->untold_s.reset();
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            Solved solved;
            solved.failure = error.what();
            solved_.post(number, std::move(solved));
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
    const std::uint64_t number = traced_.ask();
    state_.reference.clear();
    state_.map_reference.reset();
    state_.error.reset();
    // where texels lie is known when there is an answer
    const bool is_known =
        !settings_.texels || (state_.layout && solved_with_.texels == settings_.texels);
    if (reference_rays_ == 0 || !is_known) {
        tracer_.cancel();
        return;
    }
    tracer_.start(
        [this, number, definition = definition(), rays = reference_rays_, model = state_.model,
         layout = settings_.texels ? state_.layout : nullptr,
         padding = settings_.texels ? settings_.texels->padding : 0](const Progress& progress) {
            Traced traced;
            try {
                Stopwatch watch;
                if (layout)
                    traced.map = std::make_shared<const ModelMap>(
                        reference_map(*model, layout->layout, definition, rays, padding, progress));
                else
                    traced.found = truth_of(*model, definition, rays, progress);
                traced.seconds = watch.lap();
            } catch (const Cancelled&) {
                throw;
            } catch (const std::exception& error) {
                traced.failure = error.what();
            }
            traced_.post(number, std::move(traced));
        });
}

void Session::give_up()
{
    static_cast<void>(solved_.ask());
    static_cast<void>(traced_.ask());
    solver_.cancel();
    tracer_.cancel();
}

void Session::take_pose(std::shared_ptr<const Model> posed, const PoseName& name,
                        ModelAnswer answer, bool is_whole)
{
    SURFELAO_CHECK(state_.model && !making_ && answer.values.size() == posed->answer_count());
    static_cast<void>(solved_.ask());
    solver_.cancel();
    state_.model = std::move(posed);
    state_.pose = name;
    state_.prepared.reset();
    was_cancelled_ = false;
    occlusion_ = std::move(answer.values);
    at_points_ = std::move(answer.at_points);
    solved_with_ = settings_;
    solved_with_.engine.definition = definition();
    state_.is_solved = true;
    state_.is_draft = !is_whole;
    state_.build_s.reset();
    state_.solve_s = answer.seconds;
    state_.message.clear();
    ++state_.answer_count;
    has_other_pose_ = true;
    start_reference();
    if (!is_whole)
        start_solve();
}

void Session::take_bodies(std::shared_ptr<const PosedBodies> bodies)
{
    state_.pose.bodies = std::move(bodies);
    has_other_bodies_ = true;
}

void Session::solve_again()
{
    if (state_.model && !making_)
        solve_or_make();
}

void Session::cancel()
{
    was_cancelled_ = solver_.busy();
    making_.reset();
    solver_.cancel();
    tracer_.cancel();
}

void Session::measure()
{
    state_.error.reset();
    if (state_.is_solved && !state_.layout && !state_.reference.empty() && !at_points_.empty() &&
        !truth_.truth.points.empty() && solved_with_.max_distance == settings_.max_distance &&
        solved_with_.ground == settings_.ground)
        state_.error = error_of(*state_.model, truth_, occlusion_, at_points_);
}

Session::Changes Session::update()
{
    const Solved solved = solved_.take().value_or(Solved());
    Changes changes;
    changes.pose = changes.occlusion = std::exchange(has_other_pose_, false);
    changes.bodies = std::exchange(has_other_bodies_, false);
    if (const Made* made = solved.made.get(); made && making_) {
        const Making making = *std::exchange(making_, std::nullopt);
        state_.message = made->failure;
        changes.model = made->failure.empty();
        changes.file = changes.model && !making.scene;
        if (changes.model) {
            state_.path = making.path;
            state_.model = made->model;
            state_.parts = making.parts;
            state_.beside = making.beside;
            state_.pose = made->pose;
            state_.read_s = made->seconds;
            state_.is_solved = false;
            state_.layout.reset();
            state_.map.reset();
            state_.prepared.reset();
            scene_ = made->scene;
            occlusion_.clear();
            start_reference();
            was_cancelled_ = false;
            start_solve();
        }
    }
    if (Answer* answer = solved.answer.get()) {
        occlusion_ = std::move(answer->found.values);
        at_points_ = std::move(answer->found.at_points);
        state_.is_solved = true;
        solved_with_ = answer->settings;
        state_.map = answer->map;
        state_.map_error = answer->map_error;
        if (std::exchange(state_.layout, answer->layout) != answer->layout && answer->layout)
            start_reference();
        ++state_.answer_count;
        state_.is_draft = answer->is_draft;
        was_cancelled_ = was_cancelled_ && answer->is_draft;
        state_.build_s = answer->build_s;
        state_.prepared = answer->prepared;
        state_.solve_s = answer->found.seconds;
        state_.message.clear();
        changes.occlusion = true;
    }
    std::string failure = solved.failure;
    if (std::optional<Traced> traced = traced_.take(); traced && !traced->failure.empty()) {
        failure = traced->failure;
    } else if (traced) {
        truth_ = std::move(traced->found);
        state_.reference_s.reset();
        if (!truth_.reference.from_cache)
            state_.reference_s = traced->seconds;
        state_.reference = std::move(truth_.reference.values);
        state_.map_reference = traced->map;
        changes.reference = true;
    }
    if (changes.occlusion || changes.reference)
        measure();
    if (!failure.empty())
        state_.message = std::move(failure);
    return changes;
}

void Session::save(const std::filesystem::path& path) const
{
    SURFELAO_CHECK(state_.is_solved);
    BakeSettings made;
    made.input = state_.path;
    made.output = path;
    made.engine = solved_with_.engine;
    made.max_distance = solved_with_.max_distance;
    made.ground = solved_with_.ground;
    made.target = solved_with_.target;
    made.texels = solved_with_.texels;
    made.parts = solved_with_.parts;
    made.beside = state_.beside;
    if (!state_.pose.is_rest()) {
        made.reading.moment = state_.pose.moment;
        made.frame = state_.model->geometry().frame;
    }
    const std::string mark = mark_of(made) + (state_.pose.by_hand ? " moved" : "");
    if (state_.layout)
        return save_map(path, mark);
    check_output(state_.path, path);
    const Scene scene = scene_to_write(path);
    write_scene(path, scene, std::span(occlusion()).first(scene.positions.size()),
                {.mark = mark, .unbaked = state_.model->mesh->unbaked});
}

/// What the file itself holds has the places that it was read with: of another pose it is written
/// anew, but for glTF, which keeps them. So are several files.
Scene Session::scene_to_write(const std::filesystem::path& path) const
{
    Scene scene = state_.model->mesh->scene;
    if (!state_.beside.empty() || (!state_.pose.is_rest() && !is_gltf(type_of(path))))
        scene.asset.reset();
    return scene;
}

void Session::save_map(const std::filesystem::path& path, const std::string& mark) const
{
    const std::vector<Map>& pages = state_.map->visibility;
    const bool is_picture = type_of(path) == FileType::unknown;
    if (pages.size() > 1 && (is_picture || state_.layout->layout.materials.empty()))
        throw InputError(path.string() + ": holds a map of one page");
    if (is_picture) {
        write_map(path, pages[0], MapDepth::byte, mark);
        return;
    }
    check_output_with_map(state_.path, path);
    const OcclusionMap picture =
        occlusion_map_of(state_.layout->layout, state_.layout->uv_set, pages, MapDepth::byte);
    static_cast<void>(write_scene_with_map(path, scene_to_write(path), picture,
                                           {.mark = mark, .unbaked = state_.model->mesh->unbaked}));
}

}  // namespace surfelao
