/// background_worker.h: one thread for long work that can be replaced at any time, and that leaves
/// its time to drawing (thread_priority.h).
#pragma once

#include "surfels/progress.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace surfelao {

/// All functions are for one owner's thread; none of them waits for the work but the destructor.
class BackgroundWorker {
public:
    /// Given a Progress whose false answer must end the work soon (by Cancelled, as all long
    /// functions of the project do). Any other exception must be caught inside.
    using Work = std::function<void(const Progress&)>;

    /// at_end: done in the thread before it ends, for what only that thread may destroy.
    explicit BackgroundWorker(std::function<void()> at_end = {});
    ~BackgroundWorker();  ///< cancels and waits
    BackgroundWorker(const BackgroundWorker&) = delete;
    BackgroundWorker& operator=(const BackgroundWorker&) = delete;

    /// Cancels what runs and what waits, and runs `work` next.
    void start(Work work);

    /// Cancels what runs and what waits.
    void cancel();

    bool busy() const;

    /// Of the work at hand, 0 to 1, as it last said itself.
    double progress() const { return progress_.load(std::memory_order_relaxed); }

private:
    void run();

    std::function<void()> at_end_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    Work next_;             // guarded by mutex_
    bool working_ = false;  // guarded by mutex_
    bool quit_ = false;     // guarded by mutex_
    std::atomic<bool> stop_{false};
    std::atomic<double> progress_{0.0};
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace surfelao
