/// errors.h: what goes wrong outside the program, and what a caller did wrong.
///
/// Bad data (files, arrays) are an InputError, which names file, element, what was found and what
/// was wanted. The machine's faults (disk full, no context) are std::runtime_error. Settings out of
/// their ranges are a SettingsError. Work that its listener stopped ends in Cancelled (progress.h).
/// What cannot happen unless this project is wrong aborts; nothing that a caller asks for does.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace surfelao {

/// A file, what describes one, or an array cannot be used. what() is one complete sentence.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A setting is out of its range, or does not go with another one or with what it is used on.
/// what() is one sentence that names the setting and the range. Nothing was done.
class SettingsError : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// Throws SettingsError with that sentence where the condition does not hold.
inline void require(bool holds, const std::string& sentence)
{
    if (!holds)
        throw SettingsError(sentence);
}

}  // namespace surfelao

/// Prints the broken condition and its place, then aborts. For mistakes of this project alone: what
/// a caller from outside may get wrong throws.
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
