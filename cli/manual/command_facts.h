/// command_facts.h: the program's table of options as manuals and completions need it.
///
/// Read from CLI::App alone, so a new option is in all of them by itself. What the table does not
/// say in so many words is read off its texts: values that can be completed are the literal words
/// of an option's type ("cpu|gpu", not "N") and of its validator; FILE, OUT, IN and PART are files,
/// DIR is a folder; the endings of files are those that the help names (".ply").
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

struct OptionFacts {
    std::vector<std::string> names;       ///< "-o", "--output"; none: an argument by its place
    std::string value;                    ///< "OUT|DIR", "[H]", an argument's name; empty: a flag
    std::string range;                    ///< "0 to 180"; empty: none
    std::string standard;                 ///< the default; empty: none
    std::string about;                    ///< one or more sentences
    std::string group;                    ///< of the help; "Options" where it has none
    std::vector<std::string> choices;     ///< literal values
    std::vector<std::string> extensions;  ///< of files: "ply"; empty: any file
    std::vector<std::string> excludes;    ///< names of options, sorted
    std::vector<std::string> needs;       ///< the same
    bool takes_files = false;
    bool takes_folders = false;
    bool is_required = false;
    bool is_optional_value = false;  ///< the value may be left out
    bool takes_several = false;      ///< words, up to the next option
    bool is_list = false;            ///< values in one word, with commas
};

struct CommandFacts {
    std::string name;                    ///< "bake"; empty: the program itself
    std::string about;                   ///< lines
    std::string footer;                  ///< lines; empty: none
    std::vector<OptionFacts> options;    ///< in the table's order
    std::vector<OptionFacts> arguments;  ///< those without a name
};

/// The program itself, then its commands.
[[nodiscard]] std::vector<CommandFacts> facts_of(CLI::App& app);

/// "a, b"
[[nodiscard]] std::string joined(const std::vector<std::string>& words, const char* between);

/// The first sentence of a text, cut at the end of a clause where it has more than 70 characters.
[[nodiscard]] std::string short_text(const std::string& about);

}  // namespace surfelao
