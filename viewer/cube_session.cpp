#include "viewer/cube_session.h"

#include <exception>
#include <utility>

namespace surfelao {

void CubeSession::start(std::function<void(News&, const Progress&)> work)
{
    is_running_ = true;
    worker_.start([this, number = news_.ask(), work = std::move(work)](const Progress& progress) {
        News news;
        try {
            work(news, progress);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            news.failure = error.what();
        }
        news_.post(number, std::move(news));
    });
}

void CubeSession::solve(CubeQuestion question)
{
    is_placing_ = false;
    start([this, question = std::move(question)](News& news, const Progress& progress) {
        const Prepared& prepared = question.prepared
                                       ? *question.prepared
                                       : own_.prepared_for(question.model, question.engine);
        const CubeSight& sight = *question.sight;
        news.map = cube_map_of(
            sight, surfelao::solve(prepared, sight.receivers, question.engine, progress).occlusion);
    });
}

void CubeSession::place(std::shared_ptr<const Model> model)
{
    is_placing_ = true;
    start([model = std::move(model)](News& news, const Progress& progress) {
        news.placement = place_cube_maps(*model->mesh, kMostPlacedMaps, progress);
    });
}

void CubeSession::cancel()
{
    is_running_ = false;
    news_.ask();
    worker_.cancel();
}

CubeSession::News CubeSession::update()
{
    std::optional<News> news = news_.take();
    if (!news || !is_running_)
        return {};
    is_running_ = false;
    return std::move(*news);
}

}  // namespace surfelao
