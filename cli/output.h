/// output.h: reports to files or to standard output.
#pragma once

#include <optional>
#include <string>

namespace surfelao {

/// Refuses a report file that could not be written, before any work. Nothing for none and for "-".
void check_report(const std::optional<std::string>& file);

/// Writes the file atomically; "-" = standard output.
void write_report(const std::string& file, const std::string& text);

}  // namespace surfelao
