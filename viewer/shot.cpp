#include "viewer/shot.h"

#include <utility>

namespace surfelao {

void Shot::set_model(std::shared_ptr<const Model> model, std::shared_ptr<const MovingFrame> moved)
{
    if (model != model_ || (moved_ && !moved))
        mesh_.reset();
    model_ = std::move(model);
    moved_ = std::move(moved);
    if (mesh_ && moved_)
        mesh_->move(moved_->shape.positions, moved_->shape.wedge_normals);
    forget();
}

bool Shot::take(const Camera& camera, PictureSize size, bool is_culled)
{
    if (is_there_ && camera == camera_ && size == size_ && is_culled == is_culled_)
        return false;
    forget();
    camera_ = camera;
    size_ = size;
    is_culled_ = is_culled;
    is_there_ = true;
    return true;
}

void Shot::forget()
{
    is_there_ = false;
    is_drawn_ = false;
    guard_.reset();
    triangles_.clear();
}

const DrawnMesh& Shot::mesh()
{
    if (!mesh_) {
        mesh_.emplace(context_, model_->geometry(), model_->mesh->surface);
        if (moved_)
            mesh_->move(moved_->shape.positions, moved_->shape.wedge_normals);
    }
    return *mesh_;
}

void Shot::draw(std::optional<GBuffer>& buffer, int guard)
{
    const int width = size_.width + 2 * guard, height = size_.height + 2 * guard;
    if (!buffer || buffer->width() != width || buffer->height() != height)
        buffer.emplace(context_, width, height);
    buffer->draw(mesh(), widened(view_of(camera_, size_.width, size_.height), size_, guard),
                 is_culled_ ? Cull::back : Cull::none);
}

const GBuffer& Shot::drawn()
{
    if (!std::exchange(is_drawn_, true))
        draw(buffer_, 0);
    return *buffer_;
}

const GBuffer& Shot::drawn_with_guard(int guard)
{
    if (guard == 0)
        return drawn();
    if (std::exchange(guard_, guard) != guard)
        draw(wide_, guard);
    return *wide_;
}

const std::vector<std::uint32_t>& Shot::triangles()
{
    if (triangles_.empty())
        triangles_ = drawn().read_triangles();
    return triangles_;
}

PixelQuestion Shot::question_for(const EngineSettings& engine)
{
    const GBuffer& seen = drawn();
    return {.model = model_,
            .view = seen.view(),
            .width = seen.width(),
            .height = seen.height(),
            .triangles = triangles(),
            .engine = engine};
}

}  // namespace surfelao
