#include "python/calls.h"

#include "engines/threads.h"
#include "surfels/progress.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace surfelao {
namespace {

/// What both threads of a call know.
struct Call {
    std::atomic<bool> is_stopped{false};
    std::mutex mutex;
    std::condition_variable ended;
    bool is_done = false;
    std::exception_ptr fault;
    std::string stage;
    double share = 0.0;
};

/// All calls of the process. A call is under way until both of its threads have left it.
class Calls {
public:
    void add(const std::shared_ptr<Call>& call)
    {
        const std::lock_guard lock(mutex_);
        if (is_closed_)
            throw Cancelled();
        calls_.push_back(call);
        threads_ += 2;
    }

    void leave(const std::shared_ptr<Call>& call)
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = std::ranges::find(calls_, call); found != calls_.end())
            calls_.erase(found);
        --threads_;
        left_.notify_all();
    }

    void close()
    {
        if (getpid() != process_)
            return;  // a fork, which has no thread but this one
        std::unique_lock lock(mutex_);
        is_closed_ = true;
        for (const std::shared_ptr<Call>& call : calls_)
            call->is_stopped = true;
        left_.wait(lock, [&] { return threads_ == 0; });
    }

private:
    const pid_t process_ = getpid();
    std::mutex mutex_;
    std::condition_variable left_;
    std::vector<std::shared_ptr<Call>> calls_;  ///< of which no thread has left
    int threads_ = 0;
    bool is_closed_ = false;
};

/// Never destroyed: a thread may leave it while the process ends.
Calls& calls()
{
    static Calls& all = *new Calls;
    return all;
}

/// Leaves the call when it goes.
class Membership {
public:
    explicit Membership(std::shared_ptr<Call> call) : call_(std::move(call)) {}
    ~Membership() { calls().leave(call_); }
    Membership(const Membership&) = delete;
    Membership& operator=(const Membership&) = delete;

private:
    std::shared_ptr<Call> call_;
};

void do_work(const std::shared_ptr<Call>& call, std::function<void(const StageProgress&)> work,
             std::optional<int> threads)
{
    const Membership membership(call);
    std::exception_ptr fault;
    try {
        std::optional<ThreadLimit> limit;
        if (threads)
            limit.emplace(*threads);
        work([&](std::string_view stage, double done) {
            const std::lock_guard lock(call->mutex);
            call->stage = stage;
            call->share = done;
            return !call->is_stopped;
        });
    } catch (...) {
        fault = std::current_exception();
    }
    work = {};  // what it owns goes before anyone knows that it is done
    const std::lock_guard lock(call->mutex);
    call->fault = std::move(fault);
    call->is_done = true;
    call->ended.notify_all();
}

/// Whether the listener wants more.
bool is_welcome(const py::object& listener, const std::string& stage, double share)
{
    return listener.is_none() || stage.empty() || !listener(stage, share).is(py::bool_(false));
}

}  // namespace

void run_call(std::function<void(const StageProgress&)> work, const py::object& listener,
              std::optional<int> threads)
{
    if (!listener.is_none() && PyCallable_Check(listener.ptr()) == 0)
        throw py::type_error("progress must be None or callable as progress(stage, done)");
    const auto call = std::make_shared<Call>();
    calls().add(call);
    const Membership membership(call);
    try {
        std::thread(do_work, call, std::move(work), threads).detach();
    } catch (...) {
        calls().leave(call);
        throw;
    }
    for (;;) {
        std::string stage;
        double share = 0.0;
        bool is_done = false;
        {
            const py::gil_scoped_release unlocked;
            std::unique_lock lock(call->mutex);
            is_done = call->ended.wait_for(lock, kLook, [&] { return call->is_done; });
            stage = call->stage;
            share = call->share;
        }
        if (is_done && call->fault)
            std::rethrow_exception(call->fault);
        if (is_done)
            return;
        try {
            if (PyErr_CheckSignals() != 0)
                throw py::error_already_set();
            if (call->is_stopped || !is_welcome(listener, stage, share))
                throw Cancelled();
        } catch (...) {
            call->is_stopped = true;
            throw;
        }
    }
}

void end_calls()
{
    const py::gil_scoped_release unlocked;
    calls().close();
}

}  // namespace surfelao
