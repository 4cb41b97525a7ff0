/// usage_sentence.h: what is wrong with a command line, in one sentence.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace surfelao {

/// app: has just thrown `error` while it parsed. Names the word that was not understood, and the
/// one that it may have been meant to be. What cannot be understood comes before what is missing:
/// a mistyped option leaves another one without its value.
[[nodiscard]] std::string usage_sentence(const CLI::App& app, const CLI::ParseError& error);

/// "\"bkae\" is no command: did you mean bake?"
[[nodiscard]] std::string no_command_sentence(const CLI::App& app, const std::string& word);

}  // namespace surfelao
