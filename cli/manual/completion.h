/// completion.h: what shells complete: commands, options, values, files by their endings.
#pragma once

#include "cli/manual/command_facts.h"

#include <string>
#include <vector>

namespace surfelao {

// Each is a whole script, for the folder where that shell looks for one; `commands` as of
// facts_of().
[[nodiscard]] std::string bash_completion(const std::vector<CommandFacts>& commands);
[[nodiscard]] std::string zsh_completion(const std::vector<CommandFacts>& commands);
[[nodiscard]] std::string fish_completion(const std::vector<CommandFacts>& commands);

}  // namespace surfelao
