#include "cli/manual/completion.h"

namespace surfelao {
namespace {

constexpr const char* kFishHead =
    R"(# surfelao's completion for fish, made from the program's table of options

function __surfelao_files --description 'Folders, and files with these endings'
    set -l begun (commandline -ct)
    for name in $begun*/
        echo $name
    end
    for ending in $argv
        for name in $begun*.$ending $begun*.(string upper $ending)
            echo $name
        end
    end
end

complete -c surfelao -f
)";

std::string fish_text(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        if (c == '\'' || c == '\\')
            result += '\\';
        result += c;
    }
    return "'" + result + "'";
}

std::string fish_values(const OptionFacts& option)
{
    if (!option.choices.empty())
        return " -a " + fish_text(joined(option.choices, " "));
    if (!option.takes_files)
        return option.takes_folders ? " -a '(__fish_complete_directories)'" : "";
    if (option.extensions.empty())
        return " -F";
    return " -a '(__surfelao_files " + joined(option.extensions, " ") + ")'";
}

std::string fish_option(const std::string& start, const OptionFacts& option)
{
    std::string line = start;
    for (const std::string& name : option.names)
        line += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
    const std::string values = fish_values(option);
    if (values == " -F")
        line += " -r";
    else if (!option.value.empty() && !option.is_optional_value)
        line += " -x";
    return line + values + " -d " + fish_text(short_text(option.about)) + "\n";
}

}  // namespace

std::string fish_completion(const std::vector<CommandFacts>& commands)
{
    std::string text = kFishHead;
    for (const CommandFacts& command : commands) {
        const bool whole = command.name.empty();
        const std::string start = std::string("complete -c surfelao -n ") +
                                  (whole ? "__fish_use_subcommand"
                                         : "'__fish_seen_subcommand_from " + command.name + "'");
        for (const OptionFacts& option : command.options)
            text += fish_option(start, option);
        for (const OptionFacts& argument : command.arguments)
            text += start + fish_values(argument) + "\n";
        if (!whole)
            text += "complete -c surfelao -n __fish_use_subcommand -a " + command.name + " -d " +
                    fish_text(short_text(command.about)) + "\n";
    }
    return text;
}

}  // namespace surfelao
