/// mailbox.h: what a background thread has found, for the thread that asked.
///
///     worker.start([&box, number = box.ask()](const Progress& progress) {
///         box.post(number, find(progress));
///     });
///     ...
///     if (std::optional<Found> found = box.take())  // once a frame
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace surfelao {

template <class Found>
class Mailbox {
public:
    /// In the asking thread. What is posted under an earlier number is dropped from now on.
    std::uint64_t ask() { return ++asked_; }

    /// In any thread; in place of what was not taken yet.
    void post(std::uint64_t number, Found found)
    {
        const std::lock_guard lock(mutex_);
        found_ = std::move(found);
        number_ = number;
    }

    /// In the asking thread: the last that was posted under the number of the last ask(), once.
    [[nodiscard]] std::optional<Found> take()
    {
        const std::lock_guard lock(mutex_);
        std::optional<Found> found = std::exchange(found_, std::nullopt);
        if (number_ != asked_)
            found.reset();
        return found;
    }

    /// In the asking thread: whether take() has something to give.
    [[nodiscard]] bool is_full() const
    {
        const std::lock_guard lock(mutex_);
        return found_.has_value() && number_ == asked_;
    }

private:
    std::uint64_t asked_ = 0;
    mutable std::mutex mutex_;
    std::optional<Found> found_;
    std::uint64_t number_ = 0;  ///< it was posted under
};

}  // namespace surfelao
