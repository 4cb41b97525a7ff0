/// threads.h: how many cores everything may use.
#pragma once

#include <memory>

namespace surfelao {

/// Limits all parallel work of the process while it lives; the smallest limit alive counts.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);  ///< >= 1, else SettingsError; above the cores: no limit
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Threads that parallel work uses now.
[[nodiscard]] int thread_count();

}  // namespace surfelao
