#include "cli/manual/completion.h"

namespace surfelao {
namespace {

/// Between single quotes, as text of a specification of _arguments.
std::string zsh_text(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        if (c == '\'')
            result += "'\\''";
        else if (c == '[' || c == ']' || c == ':' || c == '\\')
            result.append("\\") += c;
        else
            result += c;
    }
    return result;
}

/// What completes the value: "(cpu gpu)", "_files -g ..."
std::string zsh_action(const OptionFacts& option)
{
    if (!option.choices.empty() && option.is_list)
        return "_values -s , " + zsh_text(option.value) + " " + joined(option.choices, " ");
    if (!option.choices.empty())
        return "(" + joined(option.choices, " ") + ")";
    if (!option.takes_files)
        return option.takes_folders ? "_files -/" : " ";
    if (option.extensions.empty())
        return "_files";
    return "_files -g \"(#i)*.(" + joined(option.extensions, "|") + ")\"";
}

std::string zsh_value(const OptionFacts& option)
{
    if (option.value.empty())
        return "";
    const char* const kind = option.takes_several ? ":*-*:" : option.is_optional_value ? "::" : ":";
    return kind + zsh_text(option.value) + ":" + zsh_action(option);
}

std::string zsh_option(const OptionFacts& option)
{
    std::string lines;
    for (const std::string& name : option.names)
        lines += "        '*" + name + "[" + zsh_text(short_text(option.about)) + "]" +
                 zsh_value(option) + "' \\\n";
    return lines;
}

}  // namespace

std::string zsh_completion(const std::vector<CommandFacts>& commands)
{
    std::string text =
        "#compdef surfelao\n# surfelao's completion for zsh, made from the program's table of "
        "options\n\n";
    for (std::size_t i = 1; i < commands.size(); ++i) {
        text += "_surfelao_" + commands[i].name + "() {\n    _arguments \\\n";
        for (const OptionFacts& option : commands[i].options)
            text += zsh_option(option);
        for (const OptionFacts& argument : commands[i].arguments)
            text += std::string("        '") + (argument.takes_several ? "*" : "") + ":" +
                    zsh_text(argument.value) + ":" + zsh_action(argument) + "' \\\n";
        text += "        && return\n}\n\n";
    }
    text += "_surfelao() {\n    local line state\n    local -a commands=(\n";
    for (std::size_t i = 1; i < commands.size(); ++i)
        text +=
            "        '" + commands[i].name + ":" + zsh_text(short_text(commands[i].about)) + "'\n";
    text += "    )\n    _arguments -C \\\n";
    for (const OptionFacts& option : commands.front().options)
        text += zsh_option(option);
    return text +
           "        '1:command:->command' '*::argument:->argument' && return\n"
           "    case $state in\n"
           "    command) _describe command commands ;;\n"
           "    argument) (( $+functions[_surfelao_$words[1]] )) && _surfelao_$words[1] ;;\n"
           "    esac\n}\n\n_surfelao \"$@\"\n";
}

}  // namespace surfelao
