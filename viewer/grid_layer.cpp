#include "viewer/grid_layer.h"

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

/// From the file's units to the unit frame.
Placement into_frame(const Frame& frame)
{
    return {.scale = 1.0 / frame.diagonal, .translation = -frame.centre / frame.diagonal};
}

PlacedGrid placed_at(const std::shared_ptr<const ObjectGrid>& bake, const Placement& placement,
                     std::uint32_t surface = 0)
{
    return {std::shared_ptr<const AoGrid>(bake, &bake->grid), placement, bake->lift, surface};
}

/// Those that are there in the pose. objects: of its bodies.
std::vector<PlacedGrid> placed_grids(const FoundGrids& found, const GridObjects& objects,
                                     const PosedBodies& posed)
{
    const Placement at_rest = into_frame(posed.base->geometry().frame);
    std::vector<bool> is_placed(found.bakes.size(), false);
    std::vector<PlacedGrid> placed;
    for (std::size_t b = 0; b < posed.poses.size(); ++b) {
        const std::uint32_t object = objects.of_body[b];
        if (object == GridObjects::kNone || posed.poses[b].state != BodyState::placed ||
            is_placed[object])
            continue;
        is_placed[object] = true;  // what rests is several bodies
        placed.push_back(
            placed_at(found.bakes[object], posed.poses[b].placement * at_rest, object + 1));
    }
    return placed;
}

/// Empty where nothing is.
std::string what_is_left_out(const PosedBodies& posed)
{
    const auto count = std::ranges::count(posed.poses, BodyState::deformed, &BodyPose::state);
    if (count == 0)
        return {};
    return "what does not move as one piece has no AO grid: " + std::to_string(count) +
           (count == 1 ? " part is" : " parts are") + " left out";
}

}  // namespace

void GridLayer::keep_of(const std::shared_ptr<const Model>& model)
{
    forget_picture();
    if (session_.model() == model)
        return;
    session_.forget();
    pass_.reset();
    in_pass_.reset();
    own_.reset();
    own_of_.reset();
    bodies_.reset();
    objects_.reset();
    left_out_.clear();
}

bool GridLayer::leave()
{
    left_out_.clear();
    return forget_picture();
}

bool GridLayer::update()
{
    return session_.update() && forget_picture();
}

void GridLayer::find_objects(const PosedBodies* posed)
{
    if (!posed) {
        bodies_.reset();
        objects_.reset();
        return;
    }
    std::vector<bool> rests = resting_bodies(*posed);
    if (bodies_ == posed->bodies && rests_ == rests)
        return;
    bodies_ = posed->bodies;
    rests_ = std::move(rests);
    GridObjects objects = grid_objects_of(*posed->base, *bodies_, rests_);
    // equal ones stay the same, so that their grids are shown while others are made of them
    if (objects.triangles.empty())
        objects_.reset();
    else if (!objects_ || *objects_ != objects)
        objects_ = std::make_shared<const GridObjects>(std::move(objects));
}

bool GridLayer::look(Shot& shot, const Session& session, const Cell& cell,
                     const std::shared_ptr<const PosedBodies>& posed, bool is_moving)
{
    find_objects(posed.get());
    const bool is_at_base = !posed || std::ranges::all_of(posed->poses, [](const BodyPose& pose) {
        return pose == BodyPose{};
    });
    left_out_ = objects_ || (is_moving && !is_at_base) ? what_is_left_out(*posed) : std::string();
    if (!objects_ && is_moving && !is_at_base)  // nothing moves as one piece
        return forget_picture();
    EngineSettings engine = cell.settings.engine;
    engine.definition = session.definition();
    session_.ask({objects_ ? posed->base : shot.model(), objects_, *cell.grid, engine});
    const std::shared_ptr<const FoundGrids>& found = session_.found();
    if (!found || found->question.model != session_.model() || found->question.objects != objects_)
        return forget_picture();
    if (is_drawn_ && in_pass_ == found)
        return false;
    if (in_pass_ != found) {
        pass_.reset();
        own_.reset();
    }
    in_pass_ = found;
    if (objects_) {
        find_own(shot.model());
        draw(shot, placed_grids(*found, *objects_, *posed));
    } else {
        draw(shot, {placed_at(found->bakes.front(), into_frame(shot.model()->geometry().frame))});
    }
    return true;
}

void GridLayer::find_own(const std::shared_ptr<const Model>& model)
{
    if (own_ && own_of_ == model)
        return;
    std::vector<glm::vec4> of_scene(model->mesh->scene.triangles.size(), {1, 1, 1, 0});
    for (std::size_t object = 0; object < objects_->triangles.size(); ++object) {
        const ObjectTriangles& triangles = objects_->triangles[object];
        for (std::size_t i = 0; i < triangles.size(); ++i)
            of_scene[triangles[i]] = {in_pass_->bakes[object]->own[i],
                                      static_cast<float>(object + 1)};
    }
    const Geometry& geometry = model->geometry();
    std::vector<glm::vec4> texels(geometry.triangles.size());
    for (std::size_t t = 0; t < texels.size(); ++t)
        texels[t] = of_scene[geometry.scene_triangle(t)];
    own_.emplace(context_, TexelFormat::rgba32f, std::span<const glm::vec4>(texels));
    own_of_ = model;
}

void GridLayer::draw(Shot& shot, const std::vector<PlacedGrid>& objects)
{
    if (!pass_)
        pass_.emplace(context_);
    const GBuffer& seen = shot.drawn();
    if (!picture_ || picture_->width() != seen.width() || picture_->height() != seen.height())
        picture_.emplace(pass_->make_target(seen.width(), seen.height()));
    if (own_) {
        if (!own_picture_ || own_picture_->width() != seen.width() ||
            own_picture_->height() != seen.height())
            own_picture_.emplace(context_, FramebufferOptions{.width = seen.width(),
                                                              .height = seen.height(),
                                                              .colors = {TexelFormat::rg32f}});
        seen.draw_values(shot.mesh(), *own_, {1.0f, 0.0f}, *own_picture_);
    }
    pass_->draw(seen, objects, GridMerge::product, *picture_,
                own_ ? &own_picture_->color() : nullptr);
    is_drawn_ = true;
}

float GridLayer::told(glm::ivec2 pixel) const
{
    return 1.0f - picture_->read_red({pixel.x, pixel.y, 1, 1}).front();
}

std::span<const std::shared_ptr<const ObjectGrid>> GridLayer::grids() const
{
    if (!session_.found())
        return {};
    return session_.found()->bakes;
}

std::optional<double> GridLayer::progress() const
{
    return session_.solving() ? std::optional(session_.progress()) : std::nullopt;
}

}  // namespace surfelao
