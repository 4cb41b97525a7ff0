/// clones.h: functions that are compiled once per vector width, the widest chosen when the program
/// is loaded.
///
/// Internal: for the folders' own sources. For loops over lanes that a compiler sees by itself.
/// With correctly rounded operations only all clones give the same bytes: nothing is contracted
/// (cmake/options.cmake).
#pragma once

// the thread sanitizer is not up yet when the choice is made, and crashes
#if defined(__SANITIZE_THREAD__)
#define SURFELAO_CLONES
#else
#define SURFELAO_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#endif
