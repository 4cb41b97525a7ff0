/// for_all.h: loops on all threads. The one door to TBB's: its headers take a compiler longer than
/// most of our sources do.
///
/// Internal: for the folders' own sources. Bodies are called in any order; each writes to what no
/// other does, so that results are the same for any number of threads. What a body throws is thrown
/// by the loop.
#pragma once

#include <cstddef>

namespace surfelao {

/// Any body(begin, end), by reference.
class RangeBody {
public:
    template <class Body>
    explicit RangeBody(const Body& body)
        : body_(&body), call_([](const void* of, std::size_t begin, std::size_t end) {
              (*static_cast<const Body*>(of))(begin, end);
          })
    {
    }
    void operator()(std::size_t begin, std::size_t end) const { call_(body_, begin, end); }

private:
    const void* body_;
    void (*call_)(const void*, std::size_t, std::size_t);
};

/// body(from, to) for ranges that make up begin to end - 1, none halved that is not longer than
/// grain.
void for_ranges(std::size_t begin, std::size_t end, std::size_t grain, const RangeBody& body);

template <class Body>
void for_ranges(std::size_t begin, std::size_t end, std::size_t grain, const Body& body)
{
    for_ranges(begin, end, grain, RangeBody(body));
}

/// body(i) for 0 to count - 1, of which grain are worth a thread's start.
template <class Body>
void for_all(std::size_t count, std::size_t grain, const Body& body)
{
    for_ranges(0, count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            body(i);
    });
}

/// body(i) for 0 to count - 1, each some hundred instructions at most.
template <class Body>
void for_all(std::size_t count, const Body& body)
{
    constexpr std::size_t kGrain = 4096;
    for_all(count, kGrain, body);
}

/// body(i) for 0 to count - 1, each worth a thread's start.
template <class Body>
void for_tasks(std::size_t count, const Body& body)
{
    for_all(count, 1, body);
}

/// body(0, 1) and body(1, 2), on two threads.
void do_both(const RangeBody& body);

/// left() and right(), on two threads.
template <class Left, class Right>
void do_both(const Left& left, const Right& right)
{
    do_both(RangeBody([&](std::size_t i, std::size_t) {
        if (i == 0)
            left();
        else
            right();
    }));
}

/// How many threads the loops take at most.
[[nodiscard]] std::size_t loop_threads();

}  // namespace surfelao
