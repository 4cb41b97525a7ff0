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
    worker_.start([this, number = ++number_, question = question_](const Progress& progress) {
        auto news = std::make_unique<News>();
        news->number = number;
        try {
            const auto in_stage = [&](std::string_view stage, double done) {
                return progress(stage == "repair" ? 1.0 : done);  // which is short
            };
            news->bake = std::make_shared<const GridBake>(bake_grid(
                question.model->occluding(), question.grid, question.engine, 0, in_stage));
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            news->failure = error.what();
        }
        const std::lock_guard lock(mailbox_);
        news_ = std::move(news);
    });
}

void GridSession::forget()
{
    ++number_;
    is_asked_ = was_cancelled_ = false;
    found_.reset();
    message_.clear();
    worker_.cancel();
}

bool GridSession::update()
{
    std::unique_ptr<News> news;
    {
        const std::lock_guard lock(mailbox_);
        news = std::move(news_);
    }
    if (!news || news->number != number_)
        return false;
    message_ = news->failure;
    found_ = news->bake;
    return true;
}

}  // namespace surfelao
