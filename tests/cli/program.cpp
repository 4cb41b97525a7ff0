#include "program.h"

#include "temporary_folder.h"

#include <fcntl.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cstdlib>

#include <atomic>
#include <stdexcept>

namespace surfelao {
namespace {

/// Mesa's compiled shaders stay where they are though the cache folder moves: compiling them anew
/// is most of what a small picture takes.
void keep_shader_cache()
{
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    if (cache != nullptr || home != nullptr)
        setenv("MESA_SHADER_CACHE_DIR",
               (cache != nullptr ? std::string(cache) : home + std::string("/.cache")).c_str(), 0);
}

/// In the child: standard output to the file, standard error to the file or the terminal.
[[noreturn]] void become_program(const std::vector<std::string>& arguments, const std::string& out,
                                 int err, const std::string& cache)
{
    const int descriptor = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(descriptor, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    keep_shader_cache();
    setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    unsetenv("DISPLAY");
    std::vector<char*> words = {const_cast<char*>(SURFELAO_PROGRAM)};
    for (const std::string& argument : arguments)
        words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    execv(SURFELAO_PROGRAM, words.data());
    _exit(127);
}

}  // namespace

Program::Program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                 bool terminal)
{
    static std::atomic<int> count{0};
    const std::filesystem::path logs =
        folder.string() + ".logs" + std::to_string(count++);  // beside it: tests count its files
    std::filesystem::create_directories(logs);
    out_ = logs / "out";
    err_ = logs / "err";
    int err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (terminal) {
        close(err);
        if (openpty(&terminal_, &err, nullptr, nullptr, nullptr) != 0)
            throw std::runtime_error("no terminal");
    }
    child_ = fork();
    if (child_ == 0)
        become_program(arguments, out_, err, (logs / "cache").string());
    close(err);
}

Program::~Program()
{
    if (child_ > 0) {
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }
    if (terminal_ >= 0)
        close(terminal_);
    std::error_code error;
    std::filesystem::remove_all(out_.parent_path(), error);
}

void Program::send(int signal) const
{
    kill(child_, signal);
}

Outcome Program::wait()
{
    Outcome outcome;
    if (terminal_ >= 0) {  // read on, or the program waits for a full terminal
        char buffer[4096];
        for (ssize_t got; (got = read(terminal_, buffer, sizeof buffer)) > 0;)
            outcome.err.append(buffer, static_cast<std::size_t>(got));
    }
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = contents_of(out_);
    outcome.err += contents_of(err_);
    return outcome;
}

Outcome run(const std::filesystem::path& folder, const std::vector<std::string>& arguments)
{
    return Program(folder, arguments).wait();
}

}  // namespace surfelao
