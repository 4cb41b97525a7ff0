/// run_facts.h: where, when and by what a report was made, so that it can be repeated and cited.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace surfelao {

using RunFacts = std::vector<std::pair<std::string, std::string>>;

/// Names and values in this order: program, command, date, processor, cores, instructions, memory,
/// system, compiler, libraries. The date is that of SOURCE_DATE_EPOCH where it is set, in UTC. What
/// the machine does not tell is left out.
[[nodiscard]] RunFacts run_facts();

/// "surfelao 0.1.0 (1be7d18), 2026-12-01, Xeon ..., 2 cores": how such a report is cited.
[[nodiscard]] std::string citation_of(const RunFacts& facts);

}  // namespace surfelao
