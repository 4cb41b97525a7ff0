#include "viewer/cube_session.h"

#include <exception>
#include <utility>

namespace surfelao {

void CubeSession::ask(CubeQuestion question)
{
    question_ = std::move(question);
    next_ = 0;
    is_running_ = false;
    ++number_;
    message_.clear();
    start_next();
}

void CubeSession::add(std::shared_ptr<const CubeSight> sight)
{
    message_.clear();
    sights_.push_back(std::move(sight));
    start_next();
}

void CubeSession::forget()
{
    sights_.clear();
    next_ = 0;
    cancel();
}

void CubeSession::cancel()
{
    sights_.resize(next_);
    is_running_ = false;
    ++number_;
    worker_.cancel();
}

void CubeSession::start_next()
{
    if (is_running_ || next_ >= sights_.size() || !question_.model)
        return;
    is_running_ = true;
    worker_.start([this, number = ++number_, question = question_,
                   sight = sights_[next_]](const Progress& progress) {
        auto found = std::make_unique<Found>();
        found->number = number;
        try {
            const Prepared& prepared = question.prepared
                                           ? *question.prepared
                                           : own_.prepared_for(question.model, question.engine);
            found->map = cube_map_of(
                *sight, solve(prepared, sight->receivers, question.engine, progress).occlusion);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            found->failure = error.what();
        }
        const std::lock_guard lock(mailbox_);
        found_ = std::move(found);
    });
}

std::vector<CubeMap> CubeSession::update()
{
    std::unique_ptr<Found> found;
    {
        const std::lock_guard lock(mailbox_);
        found = std::move(found_);
    }
    if (!found || found->number != number_)
        return {};
    is_running_ = false;
    if (!found->failure.empty()) {
        message_ = found->failure;
        sights_.resize(next_);
        return {};
    }
    ++next_;
    start_next();
    std::vector<CubeMap> maps;
    maps.push_back(std::move(found->map));
    return maps;
}

}  // namespace surfelao
