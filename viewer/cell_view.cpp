#include "viewer/cell_view.h"

#include "viewer/coarse.h"

#include <cmath>

namespace surfelao {
namespace {

std::optional<double> progress_of(const PixelSession& session)
{
    return session.solving() ? std::optional(session.progress()) : std::nullopt;
}

}  // namespace

CellView::CellView(const GlContext& context)
    : context_(context), renderer_(context), shot_(context), cubes_(context), grid_(context)
{
}

CellView::Changes CellView::update()
{
    Changes changes;
    static_cast<Session::Changes&>(changes) = session_.update();
    const SessionState& state = session_.state();
    if (changes.model || changes.pose)
        take_model(changes);
    if (!moved_)
        posed_ = state.pose.bodies;
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
    const bool has_rays = rays_.update();
    if (has_rays && !rays_.answers().picture.empty()) {
        rays_picture_.emplace(upload(rays_.answers()));
        changes.pixels = true;
    }
    changes.pixels |= cubes_.update();
    changes.pixels |= grid_.update();
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
    grid_.keep_of(state.pose.bodies ? state.pose.bodies->base : state.model);
    layout_.reset();
    drawn_ = state.model;
    shot_.set_model(drawn_);
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
        renderer_.set_model(*base);
        has_coarse_ = false;
        if (paint_)
            renderer_.set_paint(*paint_);
    }
    if (layout_)
        renderer_.forget_layout();
    layout_.reset();
    moved_ = frame;
    posed_ = frame->bodies;
    moved_has_values_ = has_values;
    renderer_.set_shape(frame->shape);
    if (has_values)
        renderer_.set_occlusion(frame->values);
    forget_shot();
    shot_.set_model(base, frame);
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
    const bool had_pixels = has_pixels();
    const bool is_same = !shot_.take(camera, size, view.cull);
    const bool rests = is_same && !is_moved() && !view.coarse;
    bool has_changed = !is_same && had_pixels;
    if (!is_same)
        forget_answers();
    if (drawn_->geometry().triangles.empty())
        return has_changed;
    const Where where = where_of(cell);
    const bool shows_radius = view.colors == Colors::radius && has_radius(cell);
    if (where != Where::pixels || cell.screen)
        has_changed |= forget_picture();
    if (where != Where::pixels || !cell.screen)
        has_changed |= forget_screen();
    if (where != Where::cube_maps)
        has_changed |= cubes_.forget_picture();
    if (where != Where::grid)
        has_changed |= grid_.leave();
    if (where == Where::cube_maps && !is_moved()) {
        has_changed |= cubes_.look(shot_, session_, cell, rests, view.colors == Colors::coverage);
    } else if (where == Where::grid) {
        has_changed |= grid_.look(shot_, session_, cell, posed_, is_moved());
    } else if (where == Where::pixels && cell.screen) {
        has_changed |= draw_screen(cell, shows_radius);
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
    shot_.forget();
    forget_answers();
}

/// Of the last shot.
void CellView::forget_answers()
{
    forget_picture();
    forget_screen();
    cubes_.forget_picture();
    grid_.forget_picture();
    rays_.forget();
    rays_asked_.reset();
    rays_picture_.reset();
    error_.reset();
    is_measured_ = false;
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

bool CellView::draw_screen(const Cell& cell, bool shows_radius)
{
    const auto guard =
        static_cast<int>(std::lround(cell.guard * static_cast<float>(shot_.size().height)));
    ScreenQuestion wanted{*cell.screen, session_.definition(), guard, shows_radius};
    wanted.definition.ground.reset();  // pictures do not know it
    if (screen_asked_ == wanted)
        return false;
    if (!screen_)
        screen_.emplace(context_);
    const GBuffer& seen = shot_.drawn_with_guard(guard);
    if (!screen_picture_ || screen_picture_->width() != seen.width() ||
        screen_picture_->height() != seen.height())
        screen_picture_.emplace(screen_->make_target(seen));
    if (shows_radius)
        screen_->draw_radius(seen, wanted.settings, wanted.definition, *screen_picture_);
    else
        screen_->draw(seen, wanted.settings, wanted.definition, *screen_picture_);
    shot_.drawn();  // tells of the pixels' surface
    screen_asked_ = wanted;
    return true;
}

void CellView::ask_pixels(EngineSettings engine)
{
    engine.definition = session_.definition();
    if (asked_ == engine || !session_.can_be_asked(engine))
        return;
    PixelQuestion question = shot_.question_for(engine);
    question.prepared = session_.shared_engine(engine);
    pixels_.solve(std::move(question));
    was_cancelled_ = false;
    asked_ = engine;
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
    PixelQuestion question = shot_.question_for(engine);
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
        values.guard = screen_asked_->guard;
    } else if (cubes_.picture()) {
        values.own = cubes_.picture();
        values.form = PixelForm::covered;
    } else if (grid_.picture()) {
        values.own = grid_.picture();
        values.form = PixelForm::visibility;
    } else if (picture_) {
        values.own = &*picture_;
    }
    if (values.own) {
        values.rays = rays_picture_ ? &*rays_picture_ : nullptr;
        values.surface = &shot_.surface();
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
    if (screen_asked_) {
        const glm::ivec2 at = pixel + screen_asked_->guard;
        return screen_picture_->read_red({at.x, at.y, 1, 1}).front();
    }
    if (cubes_.picture())
        return cubes_.told(pixel);
    return grid_.picture() ? std::optional(grid_.told(pixel)) : std::nullopt;
}

/// Of what is shown at the pixels of the sample.
void CellView::measure()
{
    is_measured_ = true;
    const Framebuffer target = renderer_.make_target(shot_.size().width, shot_.size().height);
    renderer_.draw_values(target, shot_.camera(), {.cull = shot_.is_culled()}, pixel_values());
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
    return session_.solving() || session_.tracing() || pixels_.is_busy() || rays_.is_busy() ||
           cubes_.is_busy() || grid_.is_busy();
}

std::optional<double> CellView::pixel_progress() const
{
    for (const std::optional<double> done : {cubes_.progress(), grid_.progress()}) {
        if (done)
            return done;
    }
    return progress_of(pixels_);
}

std::optional<double> CellView::ray_progress() const
{
    return progress_of(rays_);
}

const std::string& CellView::pixel_message() const
{
    for (const std::string* message :
         {&pixels_.answers().message, &rays_.answers().message, &cubes_.message()}) {
        if (!message->empty())
            return *message;
    }
    return grid_.message();
}

void CellView::cancel()
{
    session_.cancel();
    was_cancelled_ = pixels_.solving();
    pixels_.cancel();
    rays_.cancel();
    cubes_.cancel();
    grid_.cancel();
}

void CellView::solve_again()
{
    session_.solve_again();
    asked_.reset();
    rays_asked_.reset();
    cubes_.solve_again();
    grid_.solve_again();
}

}  // namespace surfelao
