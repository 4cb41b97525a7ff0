#include "files/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace surfelao {
namespace {

/// How long a program that has ended, or is no longer wanted, may stay unnoticed.
constexpr int kPatienceMs = 20;

[[noreturn]] void fail(const char* what)
{
    throw std::runtime_error(std::string(what) + ": " + std::generic_category().message(errno));
}

struct Descriptor {
    int number = -1;
    explicit Descriptor(int opened) : number(opened) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }
    void close()
    {
        if (number >= 0)
            ::close(number);
        number = -1;
    }
};

void limit(int resource, rlim_t soft, rlim_t hard)
{
    const rlimit values{soft, hard};
    setrlimit(static_cast<__rlimit_resource>(resource), &values);
}

/// In the child, between fork and exec: calls of the system alone, as other threads may have held
/// any lock.
[[noreturn]] void become(char* const* arguments, int output, int errors, pid_t parent,
                         const ChildLimits& limits)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)  // which has died already
        _exit(kNotStarted);
    setpgid(0, 0);  // Ctrl-C is for us, who end it
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    limit(RLIMIT_AS, limits.memory, limits.memory);
    limit(RLIMIT_FSIZE, limits.output, limits.output);
    limit(RLIMIT_CPU, limits.cpu_seconds, limits.cpu_seconds + 1);
    limit(RLIMIT_CORE, 0, 0);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(errors, STDERR_FILENO);
    close_range(STDERR_FILENO + 1, ~0U, 0);
    execv(arguments[0], arguments);
    _exit(kNotStarted);
}

/// Adds what has come; false at the end.
bool drain(int pipe, std::string& errors)
{
    char bytes[4096];
    const ssize_t count = read(pipe, bytes, sizeof bytes);
    if (count < 0)
        return errno == EINTR || errno == EAGAIN;
    if (errors.size() < kMostErrors)
        errors.append(bytes, static_cast<std::size_t>(count));
    return count > 0;
}

/// Ends it in any case.
struct Child {
    pid_t id = -1;
    int status = 0;
    explicit Child(pid_t started) : id(started) {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() { kill(); }
    bool has_ended()
    {
        const pid_t found = waitpid(id, &status, WNOHANG);
        if (found == 0 || (found < 0 && errno == EINTR))
            return false;
        id = -1;        // from now on it may be another's
        if (found < 0)  // whoever we are part of ignores SIGCHLD
            fail("another program cannot be waited for");
        return true;
    }
    void kill()
    {
        if (id < 0)
            return;
        ::kill(id, SIGKILL);
        while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
        }
        id = -1;
    }
};

std::string contents_of(int file)
{
    const off_t size = lseek(file, 0, SEEK_END);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    std::size_t filled = 0;
    while (filled < bytes.size()) {
        const ssize_t count =
            pread(file, bytes.data() + filled, bytes.size() - filled, static_cast<off_t>(filled));
        if (count <= 0)
            fail("the output of another program cannot be read");
        filled += static_cast<std::size_t>(count);
    }
    return bytes;
}

}  // namespace

ChildResult run_child(const std::filesystem::path& program, std::span<const std::string> arguments,
                      const ChildLimits& limits, const Progress& progress)
{
    std::vector<std::string> words{program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);

    Descriptor output(memfd_create("output", MFD_CLOEXEC));
    int ends[2] = {-1, -1};
    if (output.number < 0 || pipe2(ends, O_CLOEXEC) != 0)
        fail("another program cannot be listened to");
    Descriptor errors(ends[0]), theirs(ends[1]);
    const pid_t parent = getpid();
    const pid_t started = fork();
    if (started < 0)
        fail("another program cannot be started");
    if (started == 0)
        become(pointers.data(), output.number, theirs.number, parent, limits);
    Child child(started);
    theirs.close();

    ChildResult result;
    const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(limits.seconds);
    while (!child.has_ended()) {
        if (progress && !progress(0.0))
            throw Cancelled();
        if (std::chrono::steady_clock::now() > last) {
            child.kill();
            result.end = ChildResult::End::out_of_time;
            return result;
        }
        pollfd wanted{errors.number, POLLIN, 0};
        if (poll(&wanted, 1, kPatienceMs) > 0 && !drain(errors.number, result.errors))
            errors.close();
    }
    // a program that it has left behind may still hold the other end
    for (pollfd rest{errors.number, POLLIN, 0}; errors.number >= 0 && poll(&rest, 1, 0) > 0;) {
        if (!drain(errors.number, result.errors))
            errors.close();
    }
    if (WIFSIGNALED(child.status)) {
        result.end = ChildResult::End::killed;
        result.code = WTERMSIG(child.status);
        return result;
    }
    result.code = WEXITSTATUS(child.status);
    result.output = contents_of(output.number);
    return result;
}

}  // namespace surfelao
