#include "viewer/background_worker.h"

#include "viewer/thread_priority.h"

#include <utility>

namespace surfelao {

BackgroundWorker::BackgroundWorker(std::function<void()> at_end)
    : at_end_(std::move(at_end)), thread_([this] { run(); })
{
}

BackgroundWorker::~BackgroundWorker()
{
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        next_ = nullptr;
        stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void BackgroundWorker::start(Work work)
{
    {
        const std::lock_guard lock(mutex_);
        next_ = std::move(work);
        stop_ = true;
        progress_ = 0.0;
    }
    wake_.notify_one();
}

void BackgroundWorker::cancel()
{
    const std::lock_guard lock(mutex_);
    next_ = nullptr;
    stop_ = true;
}

bool BackgroundWorker::busy() const
{
    const std::lock_guard lock(mutex_);
    return working_ || next_;
}

void BackgroundWorker::run()
{
    const BackgroundPriority priority;
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [this] { return quit_ || next_; });
        if (quit_)
            break;
        const Work work = std::exchange(next_, nullptr);
        working_ = true;
        stop_ = false;
        lock.unlock();
        try {
            work([this](double done) {
                if (!stop_)
                    progress_ = done;
                return !stop_;
            });
        } catch (const Cancelled&) {
            // its owner wanted that
        }
        lock.lock();
        working_ = false;
    }
    lock.unlock();
    if (at_end_)
        at_end_();
}

}  // namespace surfelao
