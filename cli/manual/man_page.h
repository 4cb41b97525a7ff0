/// man_page.h: the manual of a command for man(1).
#pragma once

#include "cli/manual/command_facts.h"

#include <string>
#include <vector>

namespace surfelao {

/// In the macros of man(7). `commands` as of facts_of(); `index` says whose page it is; date is
/// YYYY-MM-DD.
[[nodiscard]] std::string man_page(const std::vector<CommandFacts>& commands, std::size_t index,
                                   const std::string& version, const std::string& date);

/// "surfelao-bake"; "surfelao" of the program itself.
[[nodiscard]] std::string page_name(const CommandFacts& command);

}  // namespace surfelao
