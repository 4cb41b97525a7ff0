/// thread_priority.h: what runs in the background leaves its time to drawing.
#pragma once

#include <memory>

namespace surfelao {

/// Made in a thread of background work: from then on that thread, and the engines' workers that
/// come to help it while this lives, get time where others leave some. With nothing else to do they
/// are as fast as before. They stay so: a system lets nobody take it back. All that work in the
/// background get the same, so that tracing goes on beside solving. Does nothing where the system
/// refuses.
class BackgroundPriority {
public:
    BackgroundPriority();
    ~BackgroundPriority();
    BackgroundPriority(const BackgroundPriority&) = delete;
    BackgroundPriority& operator=(const BackgroundPriority&) = delete;

private:
    class Observer;
    std::unique_ptr<Observer> observer_;
};

}  // namespace surfelao
