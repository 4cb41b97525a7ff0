/// errors.h: what goes wrong outside the program, and what a caller did wrong.
///
/// Bad input is an InputError and names file, element, what was found and what was wanted.
/// The machine's faults (disk full, no context) are std::runtime_error. A caller's mistake aborts.
/// Exceptions are caught once, in `main`.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace surfelao {

/// A file, or an argument that describes one, cannot be used. what() is one complete sentence.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace surfelao

/// Prints the broken condition and its place, then aborts. For callers' mistakes only.
#define SURFELAO_CHECK(condition)                                                              \
    do {                                                                                       \
        if (!(condition)) {                                                                    \
            std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition); \
            std::abort();                                                                      \
        }                                                                                      \
    } while (false)

#ifdef NDEBUG
#define SURFELAO_DCHECK(condition) static_cast<void>(0)
#else
#define SURFELAO_DCHECK(condition) SURFELAO_CHECK(condition)
#endif
