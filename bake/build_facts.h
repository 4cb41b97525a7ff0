/// build_facts.h: what this program was made of, for `--version` and for reports that others are to
/// repeat.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

struct Library {
    std::string_view name, version;
};

struct BuildFacts {
    std::string_view version;     ///< 0.1.0
    std::string_view commit;      ///< `git describe --always --tags --dirty`; empty: of no checkout
    std::string_view build_type;  ///< Release
    std::string_view compiler;    ///< GNU 12.2.0
    std::span<const Library> libraries;  ///< as they were when it was configured
};

[[nodiscard]] const BuildFacts& build_facts();

/// Instruction sets of the mask engine, widest first: those compiled in, and of these the ones that
/// this processor has.
struct InstructionSets {
    std::vector<std::string> compiled, usable;
};
[[nodiscard]] InstructionSets instruction_sets();

/// "surfelao 0.1.0 (1be7d18c02)", then a line for each of the facts and for the machine's backends
/// of OpenGL. What `--version` prints, without an end of line.
[[nodiscard]] std::string version_text();

}  // namespace surfelao
