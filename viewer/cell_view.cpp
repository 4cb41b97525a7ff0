#include "viewer/cell_view.h"

#include "pixels/seen.h"

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
    if (changes.model) {
        forget_shot();
        mesh_.reset();
        layout_.reset();
        paint_.reset();
        renderer_.set_model(*state.model);
    }
    if (changes.occlusion) {
        renderer_.set_occlusion(session_.occlusion());
        take_map();
    }
    if (changes.reference && state.map_reference)
        renderer_.set_map_reference(*state.map_reference);
    else if (changes.reference)
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
    if (changes.occlusion || changes.pixels || has_rays)
        is_measured_ = false;
    return changes;
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

bool CellView::look(const Cell& cell, const Camera& camera, PictureSize size, const PixelRays& rays)
{
    const std::shared_ptr<const Model>& model = session_.state().model;
    const Shot shot{model, camera, size};
    const bool rests = shot == shot_;
    bool has_changed = !rests && has_pixels();
    if (!rests) {
        forget_shot();
        shot_ = shot;
    }
    if (model->geometry().triangles.empty())
        return has_changed;
    if (!cell.at_pixels || cell.screen)
        has_changed |= forget_picture();
    if (!cell.at_pixels || !cell.screen)
        has_changed |= forget_screen();
    if (cell.screen)
        has_changed |= draw_screen(*cell.screen);
    else if (cell.at_pixels && rests)
        ask_pixels(cell.settings.engine);
    if (rests)
        ask_rays(rays);
    if (has_changed)
        is_measured_ = false;
    const bool is_there = cell.at_pixels ? has_pixels() : session_.state().is_solved;
    if (!is_there || rays_.answers().sample.values.empty())
        error_.reset();
    else if (!is_measured_)
        measure();
    return has_changed;
}

void CellView::forget_shot()
{
    forget_picture();
    forget_screen();
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

const GBuffer& CellView::drawn()
{
    const auto [width, height] = shot_.size;
    if (!mesh_)
        mesh_.emplace(context_, shot_.model->geometry(), shot_.model->mesh->surface);
    if (!g_buffer_ || g_buffer_->width() != width || g_buffer_->height() != height)
        g_buffer_.emplace(context_, width, height);
    if (!is_drawn_)
        g_buffer_->draw(*mesh_, view_of(shot_.camera, width, height));
    is_drawn_ = true;
    return *g_buffer_;
}

bool CellView::draw_screen(const ScreenSettings& settings)
{
    std::pair<ScreenSettings, Definition> wanted{settings, session_.definition()};
    wanted.second.ground.reset();  // pictures do not know it
    if (screen_asked_ == wanted)
        return false;
    if (!screen_)
        screen_.emplace(context_);
    const GBuffer& seen = drawn();
    if (!screen_picture_ || screen_picture_->width() != seen.width() ||
        screen_picture_->height() != seen.height())
        screen_picture_.emplace(screen_->make_target(seen));
    screen_->draw(seen, wanted.first, wanted.second, *screen_picture_);
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

/// Once the session has prepared the engine. The GPU's is not shared.
void CellView::ask_pixels(EngineSettings engine)
{
    engine.definition = session_.definition();
    const SessionState& state = session_.state();
    const bool is_prepared =
        engine.device == Device::gpu
            ? state.is_solved
            : state.prepared && state.prepared->choice() == EngineChoice(engine);
    if (asked_ == engine || !is_prepared)
        return;
    PixelQuestion question = question_for(engine);
    question.prepared = engine.device == Device::gpu ? nullptr : state.prepared;
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
    PixelQuestion question = question_for(engine);
    question.sample = kErrorPixels;
    question.whole = rays.whole;
    rays_.solve(std::move(question));
}

PixelValues CellView::pixel_values() const
{
    const bool is_screen = screen_asked_.has_value();
    PixelValues values;
    if (is_screen)
        values.own = &screen_picture_->color();
    else if (picture_)
        values.own = &*picture_;
    values.is_occlusion = is_screen;
    if (values.own) {
        values.rays = rays_picture_ ? &*rays_picture_ : nullptr;
        values.surface = &g_buffer_->surface();
    }
    return values;
}

void CellView::draw_frame(const Framebuffer& target, const Camera& camera,
                          const ViewOptions& options, glm::vec2 shift)
{
    renderer_.draw_frame(target, camera, options, shift, pixel_values());
}

/// Of what is shown at the pixels of the sample.
void CellView::measure()
{
    is_measured_ = true;
    const Framebuffer target = renderer_.make_target(shot_.size.width, shot_.size.height);
    renderer_.draw_values(target, shot_.camera, pixel_values());
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
    error_ = PixelError{error_statistics(own, traced), rays_asked_->first.rays};
}

bool CellView::is_busy() const
{
    return session_.solving() || session_.tracing() || pixels_.solving() || rays_.solving();
}

std::optional<double> CellView::pixel_progress() const
{
    return progress_of(pixels_);
}

std::optional<double> CellView::ray_progress() const
{
    return progress_of(rays_);
}

const std::string& CellView::pixel_message() const
{
    return pixels_.answers().message.empty() ? rays_.answers().message : pixels_.answers().message;
}

void CellView::cancel()
{
    session_.cancel();
    was_cancelled_ = pixels_.solving();
    pixels_.cancel();
    rays_.cancel();
}

void CellView::solve_again()
{
    session_.solve_again();
    asked_.reset();
    rays_asked_.reset();
}

}  // namespace surfelao
