#include "viewer/cube_layer.h"

#include "surfels/errors.h"

#include <glm/common.hpp>

#include <algorithm>

namespace surfelao {

void CubeLayer::forget()
{
    session_.cancel();
    places_.clear();
    asked_.reset();
    projector_.reset();
    weights_.clear();
    message_.clear();
    forget_picture();
}

bool CubeLayer::forget_picture()
{
    forget_coverage();
    return std::exchange(is_projected_, false);
}

/// And what came of its holes.
void CubeLayer::forget_coverage()
{
    coverage_.reset();
    projected_.clear();
    if (holes_asked_)
        holes_.forget();
    holes_asked_.reset();
    filled_.reset();
}

bool CubeLayer::update()
{
    CubeSession::News news = session_.update();
    if (!news.failure.empty()) {
        message_ = news.failure;
        places_.resize(weights_.size());
    }
    if (news.placement) {
        for (const glm::vec3 centre : news.placement->centres)
            places_.push_back({centre, nullptr});
    }
    if (news.map)
        take(std::move(*news.map));
    bool has_changed = news.map.has_value();
    if (holes_.update() && !holes_.answers().picture.empty()) {
        fill_holes();
        has_changed = true;
    }
    return has_changed;
}

void CubeLayer::take(CubeMap map)
{
    if (!projector_)
        projector_.emplace(context_);
    projector_->add(std::move(map), 0.0f);
    weights_.push_back(0.0f);
}

std::string CubeLayer::add(Shot& shot)
{
    if (!shot.model() || shot.model()->geometry().triangles.empty())
        return "there is nothing to put a cube map into";
    const Model& model = *shot.model();
    auto sight = std::make_shared<const CubeSight>(
        look_around(context_, *model.mesh, shot.mesh(), shot.camera().eye, kCubeSize,
                    offset_of(model.settings, model.geometry().frame)));
    if (sight->texels.empty())
        return "a cube map would see nothing from here";
    if (sight->is_inside)
        return "here is the inside of a body: no place for a cube map";
    message_.clear();
    places_.push_back({sight->centre, std::move(sight)});
    return {};
}

void CubeLayer::place(const std::shared_ptr<const Model>& model)
{
    forget();
    if (model && !model->geometry().triangles.empty())
        session_.place(model);
}

bool CubeLayer::look(Shot& shot, const Session& session, const Cell& cell, bool rests,
                     bool shows_holes)
{
    ask(session, cell);
    answer_next(shot, session);
    const bool has_changed = project(shot, rests);
    shows_holes_ = shows_holes;
    if (rests && !shows_holes_)
        ask_holes(shot, session, cell.settings.engine);
    return has_changed;
}

/// Maps that are there are solved again where somebody else is asked.
void CubeLayer::ask(const Session& session, const Cell& cell)
{
    Asked wanted{cell.settings.engine, cell.screen};
    wanted.engine.definition = session.definition();
    if (wanted.horizon)
        wanted.engine.definition.ground.reset();  // pictures do not know it
    if (asked_ == wanted || (!wanted.horizon && !session.can_be_asked(wanted.engine)))
        return;
    asked_ = wanted;
    if (!session_.placing())
        session_.cancel();
    if (projector_)
        projector_->clear();
    weights_.clear();
}

/// One map a frame at most is begun; horizons are found here and now.
void CubeLayer::answer_next(Shot& shot, const Session& session)
{
    if (!asked_ || session_.busy() || weights_.size() >= places_.size())
        return;
    Place& place = places_[weights_.size()];
    const Model& model = *shot.model();
    const Offset offset = offset_of(model.settings, model.geometry().frame);
    if (!place.sight)
        place.sight = std::make_shared<const CubeSight>(
            look_around(context_, *model.mesh, shot.mesh(), place.centre, kCubeSize, offset));
    if (place.sight->texels.empty() || place.sight->is_inside) {
        places_.erase(places_.begin() + static_cast<std::ptrdiff_t>(weights_.size()));
        return;
    }
    if (!asked_->horizon) {
        session_.solve(
            {shot.model(), asked_->engine, session.shared_engine(asked_->engine), place.sight});
        return;
    }
    if (!screen_)
        screen_.emplace(context_);
    Occluders nobody(model.occluding());
    CubeSeconds unused;
    take(make_cube_map(
        {context_, *model.mesh, shot.mesh(), nobody, *screen_}, place.centre,
        {.engine = *asked_->horizon, .definition = asked_->engine.definition, .offset = offset},
        unused));
}

/// What the maps tell of the shot, where that has changed.
bool CubeLayer::project(Shot& shot, bool rests)
{
    if (weights_.empty())
        return forget_picture();
    constexpr float kFade = 1.0f / 20.0f;  // a picture
    for (std::size_t i = 0; i < weights_.size(); ++i) {
        if (weights_[i] >= 1.0f)
            continue;
        weights_[i] = std::min(1.0f, weights_[i] + kFade);
        projector_->set_weight(i, weights_[i]);
        is_projected_ = false;
    }
    if (is_projected_) {
        if (rests && !coverage_)
            measure_coverage(shot);
        return false;
    }
    const GBuffer& seen = shot.drawn();
    if (!picture_ || picture_->width() != seen.width() || picture_->height() != seen.height())
        picture_.emplace(projector_->make_target(seen.width(), seen.height()));
    projector_->project(seen, *picture_);
    is_projected_ = true;
    forget_coverage();
    return true;
}

void CubeLayer::measure_coverage(Shot& shot)
{
    const std::vector<std::uint32_t>& triangles = shot.triangles();
    projected_ = picture_->read_color(picture_->rect());
    std::size_t seen = 0, covered = 0;
    for (std::size_t i = 0; i < projected_.size(); ++i) {
        seen += triangles[i] != 0;
        covered += triangles[i] != 0 && projected_[i].g > 0.0f;
    }
    coverage_ = seen > 0 ? static_cast<double>(covered) / static_cast<double>(seen) : 1.0;
}

/// The pixels that maps do not tell all of are solved themselves, once the maps have come.
void CubeLayer::ask_holes(Shot& shot, const Session& session, EngineSettings engine)
{
    engine.definition = session.definition();
    if (!coverage_ || holes_asked_ == engine || !session.can_be_asked(engine))
        return;
    holes_asked_ = engine;
    PixelQuestion question = shot.question_for(engine);
    for (std::size_t i = 0; i < projected_.size(); ++i) {
        if (projected_[i].g >= 1.0f)
            question.triangles[i] = 0;
    }
    if (std::ranges::all_of(question.triangles, [](std::uint32_t seen) { return seen == 0; }))
        return;
    question.prepared = session.shared_engine(engine);
    holes_.solve(std::move(question));
}

void CubeLayer::fill_holes()
{
    const PixelAnswers& found = holes_.answers();
    std::vector<glm::vec2> filled(projected_.size());
    for (std::size_t i = 0; i < filled.size(); ++i)
        filled[i] = {glm::mix(found.picture[i].w, projected_[i].r, projected_[i].g), 1.0f};
    filled_.emplace(context_, found.width, found.height, TexelFormat::rg32f,
                    std::span<const glm::vec2>(filled));
}

const Texture2D* CubeLayer::picture() const
{
    if (!is_projected_)
        return nullptr;
    return filled_ && !shows_holes_ ? &*filled_ : &picture_->color();
}

std::optional<float> CubeLayer::told(glm::ivec2 pixel) const
{
    const glm::vec4 told = picture_->read_color({pixel.x, pixel.y, 1, 1}).front();
    if (told.g >= 1.0f || holes_.answers().picture.empty())
        return told.g > 0.0f ? std::optional(told.r) : std::nullopt;
    const std::size_t index =
        static_cast<std::size_t>(pixel.x) +
        static_cast<std::size_t>(picture_->width()) * static_cast<std::size_t>(pixel.y);
    return glm::mix(holes_.answers().picture[index].w, told.r, told.g);
}

std::optional<double> CubeLayer::progress() const
{
    if (session_.busy())
        return session_.progress();
    return holes_.solving() ? std::optional(holes_.progress()) : std::nullopt;
}

const std::string& CubeLayer::message() const
{
    return holes_.answers().message.empty() ? message_ : holes_.answers().message;
}

void CubeLayer::cancel()
{
    session_.cancel();
    places_.resize(weights_.size());
    holes_.cancel();
}

}  // namespace surfelao
