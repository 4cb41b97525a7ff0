#include "viewer/grid_session.h"

#include <exception>
#include <string_view>
#include <utility>

namespace surfelao {

void GridSession::ask(GridQuestion question)
{
    question.engine.definition.ground.reset();
    if (is_asked_ && question == question_)
        return;
    question_ = std::move(question);
    is_asked_ = true;
    start();
}

void GridSession::cancel()
{
    was_cancelled_ = worker_.busy();
    worker_.cancel();
}

void GridSession::ask_again()
{
    if (was_cancelled_)
        start();
}

void GridSession::start()
{
    message_.clear();
    was_cancelled_ = false;
    worker_.start([this, number = news_.ask(), question = question_](const Progress& progress) {
        News news;
        try {
            const auto in_stage = [&](std::string_view stage, double done) {
                return progress(stage == "repair" ? 1.0 : done);  // which is short
            };
            news.bake = std::make_shared<const GridBake>(bake_grid(
                question.model->occluding(), question.grid, question.engine, 0, in_stage));
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            news.failure = error.what();
        }
        news_.post(number, std::move(news));
    });
}

void GridSession::forget()
{
    news_.ask();
    is_asked_ = was_cancelled_ = false;
    found_.reset();
    message_.clear();
    worker_.cancel();
}

bool GridSession::update()
{
    const std::optional<News> news = news_.take();
    if (!news)
        return false;
    message_ = news->failure;
    found_ = news->bake;
    return true;
}

}  // namespace surfelao
