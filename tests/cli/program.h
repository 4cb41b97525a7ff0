/// program.h: runs the program as its users do.
#pragma once

#include <sys/types.h>
#include <filesystem>
#include <string>
#include <vector>

namespace surfelao {

struct Outcome {
    int code = -1;  ///< exit code; 128 + signal where a signal ended it
    std::string out, err;
};

/// The program under way, its output caught in files of `folder`. Destroying it kills it.
class Program {
public:
    /// terminal: stderr is a terminal of its own.
    Program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
            bool terminal = false);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void send(int signal) const;
    Outcome wait();

private:
    std::filesystem::path out_, err_;
    pid_t child_ = -1;
    int terminal_ = -1;
};

/// Runs it to its end with a cache folder of its own in `folder`.
Outcome run(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

}  // namespace surfelao
