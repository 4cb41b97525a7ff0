#include "viewer/thread_priority.h"

#include <tbb/task_scheduler_observer.h>

#include <sys/resource.h>
#include <unistd.h>

namespace surfelao {
namespace {

constexpr int kNice = 5;  // a third of the time of a thread that draws

void lower_thread_priority()
{
    // on Linux a thread's own, against POSIX
    static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice));
}

}  // namespace

class BackgroundPriority::Observer : public tbb::task_scheduler_observer {
public:
    Observer() { observe(true); }
    ~Observer() override { observe(false); }
    void on_scheduler_entry(bool is_worker) override
    {
        if (is_worker)
            lower_thread_priority();
    }
};

BackgroundPriority::BackgroundPriority()
{
    lower_thread_priority();
    observer_ = std::make_unique<Observer>();
}
BackgroundPriority::~BackgroundPriority() = default;

}  // namespace surfelao
