#include "viewer/grid_layer.h"

#include <utility>

namespace surfelao {

void GridLayer::forget()
{
    session_.forget();
    objects_.clear();
    pass_.reset();
    forget_picture();
}

bool GridLayer::update()
{
    if (!session_.update())
        return false;
    objects_.clear();
    pass_.reset();
    return forget_picture();
}

bool GridLayer::look(Shot& shot, const Session& session, const Cell& cell)
{
    EngineSettings engine = cell.settings.engine;
    engine.definition = session.definition();
    session_.ask({shot.model(), *cell.grid, engine});
    if (!session_.found())
        return forget_picture();
    if (is_drawn_)
        return false;
    if (objects_.empty()) {
        const Frame& frame = shot.model()->geometry().frame;
        objects_.push_back(
            {std::shared_ptr<const AoGrid>(session_.found(), &session_.found()->grid),
             {.scale = 1.0 / frame.diagonal, .translation = -frame.centre / frame.diagonal}});
    }
    if (!pass_)
        pass_.emplace(context_);
    const GBuffer& seen = shot.drawn();
    if (!picture_ || picture_->width() != seen.width() || picture_->height() != seen.height())
        picture_.emplace(pass_->make_target(seen.width(), seen.height()));
    pass_->draw(seen, objects_, GridMerge::product, *picture_);
    is_drawn_ = true;
    return true;
}

float GridLayer::told(glm::ivec2 pixel) const
{
    return 1.0f - picture_->read_red({pixel.x, pixel.y, 1, 1}).front();
}

std::optional<double> GridLayer::progress() const
{
    return session_.solving() ? std::optional(session_.progress()) : std::nullopt;
}

}  // namespace surfelao
