#include "viewer/cell_view.h"

#include "pixels/seen.h"
#include "viewer/coarse.h"

#include <algorithm>
#include <cstddef>

namespace surfelao {
namespace {

std::optional<double> progress_of(const PixelSession& session)
{
    return session.solving() ? std::optional(session.progress()) : std::nullopt;
}

}  // namespace

CellView::CellView(const GlContext& context) : context_(context), renderer_(context)
{
}

CellView::Changes CellView::update()
{
    Changes changes;
    static_cast<Session::Changes&>(changes) = session_.update();
    const SessionState& state = session_.state();
    if (changes.model || changes.pose)
        take_model(changes);
    if (changes.occlusion && !is_moved()) {
        renderer_.set_occlusion(session_.occlusion());
        take_map();
    }
    if (changes.reference && state.map_reference && !is_moved())
        renderer_.set_map_reference(*state.map_reference);
    else if (changes.reference && !is_moved())
        renderer_.set_reference(state.reference);
    if (pixels_.update() && !pixels_.answers().picture.empty()) {
        picture_.emplace(upload(pixels_.answers()));
        changes.pixels = true;
    }
    if (holes_.update() && !holes_.answers().picture.empty()) {
        fill_holes();
        changes.pixels = true;
    }
    const bool has_rays = rays_.update();
    if (has_rays && !rays_.answers().picture.empty()) {
        rays_picture_.emplace(upload(rays_.answers()));
        changes.pixels = true;
    }
    for (CubeMap& map : cubes_.update()) {
        if (!projector_)
            projector_.emplace(context_);
        projector_->add(std::move(map), 0.0f);
        map_weights_.push_back(0.0f);
        changes.pixels = true;
    }
    if (changes.occlusion || changes.pixels || has_rays)
        is_measured_ = false;
    return changes;
}

/// The session's model is shown again, or another one.
void CellView::take_model(const Session::Changes& changes)
{
    const SessionState& state = session_.state();
    moved_.reset();
    forget_shot();
    cubes_.forget();
    maps_asked_.reset();
    projector_.reset();
    map_weights_.clear();
    mesh_.reset();
    layout_.reset();
    drawn_ = state.model;
    renderer_.set_model(*drawn_);
    has_coarse_ = false;
    // triangles that a pose has left out take their paint with them
    const std::size_t triangles = drawn_->geometry().triangles.size();
    if (!changes.pose || (paint_ && paint_->triangles.size() != triangles))
        paint_.reset();
    if (paint_)
        renderer_.set_paint(*paint_);
}

void CellView::show_moved(const std::shared_ptr<const Model>& base,
                          const std::shared_ptr<const MovingFrame>& frame, bool has_values)
{
    if (drawn_ != base) {
        drawn_ = base;
        mesh_.reset();
        renderer_.set_model(*base);
        has_coarse_ = false;
        if (paint_)
            renderer_.set_paint(*paint_);
    }
    if (layout_)
        renderer_.forget_layout();
    layout_.reset();
    moved_ = frame;
    moved_has_values_ = has_values;
    renderer_.set_shape(frame->shape);
    if (has_values)
        renderer_.set_occlusion(frame->values);
    if (mesh_)
        mesh_->move(frame->shape.positions, frame->shape.wedge_normals);
    forget_shot();
}

std::span<const glm::vec3> CellView::positions() const
{
    return moved_ ? moved_->shape.positions : drawn_->geometry().positions;
}

std::span<const glm::vec3> CellView::wedge_normals() const
{
    return moved_ ? moved_->shape.wedge_normals : session_.state().model->mesh->surface.normals;
}

std::span<const Occlusion> CellView::vertex_values() const
{
    if (moved_)
        return moved_has_values_ ? std::span<const Occlusion>(moved_->values)
                                 : std::span<const Occlusion>();
    const SessionState& state = session_.state();
    if (!state.is_solved || state.layout)
        return {};
    return std::span(session_.occlusion()).first(drawn_->geometry().positions.size());
}

bool CellView::can_show(Colors colors) const
{
    return has_values() || colors == Colors::levels || colors == Colors::textured ||
           (colors == Colors::rays && has_reference());
}

bool CellView::has_values() const
{
    return has_pixels() || (moved_ ? moved_has_values_ : session_.state().is_solved);
}

/// The answer's map, or that it has none.
void CellView::take_map()
{
    const SessionState& state = session_.state();
    if (!state.layout)
        renderer_.forget_layout();
    else if (state.layout != layout_)
        renderer_.set_layout(*state.model->mesh, *state.layout);
    layout_ = state.layout;
    if (state.map)
        renderer_.set_map(*state.map);
}

std::span<const std::string> CellView::take_paint()
{
    if (!paint_) {
        paint_ = base_paint_of(*session_.state().model->mesh);
        renderer_.set_paint(*paint_);
    }
    return paint_->notes;
}

Texture2D CellView::upload(const PixelAnswers& found) const
{
    return {context_, found.width, found.height, TexelFormat::rgba32f,
            std::span<const glm::vec4>(found.picture)};
}

bool CellView::look(const Cell& cell, const Camera& camera, PictureSize size, const PixelRays& rays,
                    const ViewOptions& view)
{
    const Shot shot{drawn_, camera, size, view.cull};
    const bool is_same = shot == shot_;
    const bool rests = is_same && !is_moved() && !view.coarse;
    bool has_changed = !is_same && has_pixels();
    if (!is_same) {
        forget_shot();
        shot_ = shot;
    }
    if (drawn_->geometry().triangles.empty())
        return has_changed;
    const Where where = where_of(cell);
    const bool shows_radius = view.colors == Colors::radius && has_radius(cell);
    if (where != Where::pixels || cell.screen)
        has_changed |= forget_picture();
    if (where != Where::pixels || !cell.screen)
        has_changed |= forget_screen();
    if (where != Where::cube_maps)
        has_changed |= forget_projection();
    if (where == Where::cube_maps && !is_moved()) {
        ask_maps(cell.settings.engine);
        has_changed |= project(rests);
        shows_holes_ = view.colors == Colors::coverage;
        if (rests && !shows_holes_)
            ask_holes(cell.settings.engine);
    } else if (where == Where::pixels && cell.screen) {
        has_changed |= draw_screen(*cell.screen, shows_radius);
    } else if (where == Where::pixels && rests) {
        ask_pixels(cell.settings.engine);
    }
    if (rests)
        ask_rays(rays);
    if (has_changed)
        is_measured_ = false;
    const bool is_there = cell.at_pixels ? has_pixels() : session_.state().is_solved;
    if (!is_there || shows_radius || rays_.answers().sample.values.empty())
        error_.reset();
    else if (!is_measured_)
        measure();
    return has_changed;
}

void CellView::forget_shot()
{
    forget_picture();
    forget_screen();
    forget_projection();
    rays_.forget();
    rays_asked_.reset();
    rays_picture_.reset();
    is_drawn_ = false;
    triangles_.clear();
    error_.reset();
    is_measured_ = false;
    shot_ = {};
}

/// Whether there was one.
bool CellView::forget_picture()
{
    if (asked_)
        pixels_.forget();
    was_cancelled_ = false;
    asked_.reset();
    const bool was_there = picture_.has_value();
    picture_.reset();
    return was_there;
}

bool CellView::forget_screen()
{
    const bool was_there = screen_asked_.has_value();
    screen_asked_.reset();
    return was_there;
}

bool CellView::forget_projection()
{
    forget_coverage();
    return std::exchange(is_projected_, false);
}

/// And what came of its holes.
void CellView::forget_coverage()
{
    coverage_.reset();
    projected_.clear();
    if (holes_asked_)
        holes_.forget();
    holes_asked_.reset();
    filled_.reset();
}

const GBuffer& CellView::drawn()
{
    const auto [width, height] = shot_.size;
    if (!mesh_) {
        mesh_.emplace(context_, shot_.model->geometry(), shot_.model->mesh->surface);
        if (moved_)
            mesh_->move(moved_->shape.positions, moved_->shape.wedge_normals);
    }
    if (!g_buffer_ || g_buffer_->width() != width || g_buffer_->height() != height)
        g_buffer_.emplace(context_, width, height);
    if (!is_drawn_)
        g_buffer_->draw(*mesh_, view_of(shot_.camera, width, height),
                        shot_.is_culled ? Cull::back : Cull::none);
    is_drawn_ = true;
    return *g_buffer_;
}

bool CellView::draw_screen(const ScreenSettings& settings, bool shows_radius)
{
    ScreenQuestion wanted{settings, session_.definition(), shows_radius};
    wanted.definition.ground.reset();  // pictures do not know it
    if (screen_asked_ == wanted)
        return false;
    if (!screen_)
        screen_.emplace(context_);
    const GBuffer& seen = drawn();
    if (!screen_picture_ || screen_picture_->width() != seen.width() ||
        screen_picture_->height() != seen.height())
        screen_picture_.emplace(screen_->make_target(seen));
    if (shows_radius)
        screen_->draw_radius(seen, settings, wanted.definition, *screen_picture_);
    else
        screen_->draw(seen, settings, wanted.definition, *screen_picture_);
    screen_asked_ = wanted;
    return true;
}

PixelQuestion CellView::question_for(const EngineSettings& engine)
{
    const GBuffer& seen = drawn();
    if (triangles_.empty())
        triangles_ = seen.read_triangles();
    return {.model = shot_.model,
            .view = seen.view(),
            .width = seen.width(),
            .height = seen.height(),
            .triangles = triangles_,
            .engine = engine};
}

/// By the session; null where whoever asks prepares an engine of its own: the GPU's, and that of a
/// pose that the session has not solved itself.
std::shared_ptr<const Prepared> CellView::prepared_for(const EngineSettings& engine) const
{
    const std::shared_ptr<const Prepared>& prepared = session_.state().prepared;
    const bool is_shared =
        engine.device != Device::gpu && prepared && prepared->choice() == EngineChoice(engine);
    return is_shared ? prepared : nullptr;
}

/// By the session. The GPU's engine is not shared.
bool CellView::is_prepared(const EngineSettings& engine) const
{
    const SessionState& state = session_.state();
    if (engine.device == Device::gpu || !state.pose.is_rest())
        return state.is_solved && !state.is_draft;
    return state.prepared && state.prepared->choice() == EngineChoice(engine);
}

void CellView::ask_pixels(EngineSettings engine)
{
    engine.definition = session_.definition();
    if (asked_ == engine || !is_prepared(engine))
        return;
    PixelQuestion question = question_for(engine);
    question.prepared = prepared_for(engine);
    pixels_.solve(std::move(question));
    was_cancelled_ = false;
    asked_ = engine;
}

void CellView::ask_maps(EngineSettings engine)
{
    engine.definition = session_.definition();
    if (maps_asked_ == engine || !is_prepared(engine))
        return;
    maps_asked_ = engine;
    if (projector_)
        projector_->clear();
    map_weights_.clear();
    cubes_.ask({shot_.model, engine, prepared_for(engine)});
}

std::string CellView::add_map()
{
    if (!shot_.model || shot_.model->geometry().triangles.empty())
        return "there is nothing to put a cube map into";
    static_cast<void>(drawn());  // makes the mesh
    const Mesh& mesh = *shot_.model->mesh;
    auto sight = std::make_shared<const CubeSight>(
        look_around(context_, mesh, *mesh_, shot_.camera.eye, kCubeSize,
                    offset_of(shot_.model->settings, mesh.geometry.frame)));
    if (sight->texels.empty())
        return "a cube map would see nothing from here";
    if (sight->is_inside)
        return "here is the inside of a body: no place for a cube map";
    cubes_.add(std::move(sight));
    return {};
}

/// What the maps tell of the shot, where that has changed.
bool CellView::project(bool rests)
{
    if (map_weights_.empty())
        return forget_projection();
    constexpr float kFade = 1.0f / 20.0f;  // a picture
    for (std::size_t i = 0; i < map_weights_.size(); ++i) {
        if (map_weights_[i] >= 1.0f)
            continue;
        map_weights_[i] = std::min(1.0f, map_weights_[i] + kFade);
        projector_->set_weight(i, map_weights_[i]);
        is_projected_ = false;
    }
    if (is_projected_) {
        if (rests && !coverage_)
            measure_coverage();
        return false;
    }
    const GBuffer& seen = drawn();
    if (!map_picture_ || map_picture_->width() != seen.width() ||
        map_picture_->height() != seen.height())
        map_picture_.emplace(projector_->make_target(seen.width(), seen.height()));
    projector_->project(seen, *map_picture_);
    is_projected_ = true;
    forget_coverage();
    return true;
}

void CellView::measure_coverage()
{
    if (triangles_.empty())
        triangles_ = drawn().read_triangles();
    projected_ = map_picture_->read_color(map_picture_->rect());
    std::size_t seen = 0, covered = 0;
    for (std::size_t i = 0; i < projected_.size(); ++i) {
        seen += triangles_[i] != 0;
        covered += triangles_[i] != 0 && projected_[i].g > 0.0f;
    }
    coverage_ = seen > 0 ? static_cast<double>(covered) / static_cast<double>(seen) : 1.0;
}

/// The pixels that maps do not tell all of are solved themselves, once the maps have come.
void CellView::ask_holes(EngineSettings engine)
{
    engine.definition = session_.definition();
    if (!coverage_ || holes_asked_ == engine || !is_prepared(engine))
        return;
    holes_asked_ = engine;
    PixelQuestion question = question_for(engine);
    for (std::size_t i = 0; i < projected_.size(); ++i) {
        if (projected_[i].g >= 1.0f)
            question.triangles[i] = 0;
    }
    if (std::ranges::all_of(question.triangles, [](std::uint32_t seen) { return seen == 0; }))
        return;
    question.prepared = prepared_for(engine);
    holes_.solve(std::move(question));
}

void CellView::fill_holes()
{
    const PixelAnswers& found = holes_.answers();
    std::vector<glm::vec2> filled(projected_.size());
    for (std::size_t i = 0; i < filled.size(); ++i)
        filled[i] = {glm::mix(found.picture[i].w, projected_[i].r, projected_[i].g), 1.0f};
    filled_.emplace(context_, found.width, found.height, TexelFormat::rg32f,
                    std::span<const glm::vec2>(filled));
}

void CellView::ask_rays(const PixelRays& rays)
{
    const std::pair<PixelRays, Definition> wanted{rays, session_.definition()};
    if (rays_asked_ == wanted)
        return;
    rays_asked_ = wanted;
    rays_picture_.reset();
    is_measured_ = false;
    if (rays.rays == 0)
        return rays_.forget();
    EngineSettings engine;
    engine.engine = Engine::rays;
    engine.rays = rays.rays;
    engine.definition = wanted.second;
    PixelQuestion question = question_for(engine);
    question.sample = kErrorPixels;
    question.whole = rays.whole;
    rays_.solve(std::move(question));
}

PixelValues CellView::pixel_values() const
{
    PixelValues values;
    if (screen_asked_) {
        values.own = &screen_picture_->color();
        values.form = PixelForm::occlusion;
    } else if (is_projected_) {
        values.own = filled_ && !shows_holes_ ? &*filled_ : &map_picture_->color();
        values.form = PixelForm::covered;
    } else if (picture_) {
        values.own = &*picture_;
    }
    if (values.own) {
        values.rays = rays_picture_ ? &*rays_picture_ : nullptr;
        values.surface = &g_buffer_->surface();
    }
    return values;
}

void CellView::draw_frame(const Framebuffer& target, const Camera& camera,
                          const ViewOptions& options, glm::vec2 shift)
{
    if (options.coarse && !has_coarse_) {
        const Mesh& mesh = *drawn_->mesh;
        const std::vector<glm::uvec3> triangles =
            coarse_triangles(mesh.geometry, mesh.surface, kCoarseTriangles);
        if (!triangles.empty())
            renderer_.set_coarse(triangles);
        has_coarse_ = true;
    }
    renderer_.draw_frame(target, camera, options, shift, pixel_values());
}

std::optional<float> CellView::told_by_picture(glm::ivec2 pixel) const
{
    const Rect part{pixel.x, pixel.y, 1, 1};
    if (screen_asked_)
        return screen_picture_->read_red(part).front();
    if (!is_projected_)
        return std::nullopt;
    const glm::vec4 told = map_picture_->read_color(part).front();
    if (told.g >= 1.0f || holes_.answers().picture.empty())
        return told.g > 0.0f ? std::optional(told.r) : std::nullopt;
    const std::size_t index =
        static_cast<std::size_t>(pixel.x) + static_cast<std::size_t>(shot_.size.width * pixel.y);
    return glm::mix(holes_.answers().picture[index].w, told.r, told.g);
}

/// Of what is shown at the pixels of the sample.
void CellView::measure()
{
    is_measured_ = true;
    const Framebuffer target = renderer_.make_target(shot_.size.width, shot_.size.height);
    renderer_.draw_values(target, shot_.camera, {.cull = shot_.is_culled}, pixel_values());
    const std::vector<glm::vec4> shown = target.read_color(target.rect());
    const PixelSample& sample = rays_.answers().sample;
    std::vector<Occlusion> own, traced;
    for (std::size_t i = 0; i < sample.pixels.size(); ++i) {
        const glm::vec4& value = shown[sample.pixels[i]];
        if (value.a == 0.0f)  // an edge that this drawing has rounded to the other side
            continue;
        own.push_back({value.r, glm::vec3(0.0f)});
        traced.push_back(sample.values[i]);
    }
    error_ = ShownError{error_statistics(own, traced), rays_asked_->first.rays};
}

bool CellView::is_busy() const
{
    return session_.solving() || session_.tracing() || pixels_.solving() || rays_.solving() ||
           holes_.solving() || cubes_.solving();
}

std::optional<double> CellView::pixel_progress() const
{
    if (cubes_.solving())
        return cubes_.progress();
    if (holes_.solving())
        return holes_.progress();
    return progress_of(pixels_);
}

std::optional<double> CellView::ray_progress() const
{
    return progress_of(rays_);
}

const std::string& CellView::pixel_message() const
{
    for (const std::string* message :
         {&pixels_.answers().message, &holes_.answers().message, &rays_.answers().message}) {
        if (!message->empty())
            return *message;
    }
    return cubes_.message();
}

void CellView::cancel()
{
    session_.cancel();
    was_cancelled_ = pixels_.solving();
    pixels_.cancel();
    rays_.cancel();
    holes_.cancel();
    cubes_.cancel();
}

void CellView::solve_again()
{
    session_.solve_again();
    asked_.reset();
    holes_asked_.reset();
    rays_asked_.reset();
}

}  // namespace surfelao
