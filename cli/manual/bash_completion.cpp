#include "cli/manual/completion.h"

namespace surfelao {
namespace {

constexpr const char* kBashHead =
    R"(# surfelao's completion for bash, made from the program's table of options

# _surfelao_table COMMAND [OPTION]: of a command its options (words) and the endings of its arguments
# (files); of an option what it takes (one, several, optional, list; nothing: a flag) and its values.
# files: endings, or / for folders, or * for any file
_surfelao_table()
{
    takes= words= files=
    case "$*" in
)";

constexpr const char* kBashTail = R"(    esac
}

_surfelao_complete()  # words and files that begin as $cur
{
    local before= ending
    [[ $takes == list && $cur == *,* ]] && before=${cur%,*},
    [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -P "$before" -W "$words" -- "${cur##*,}")
    [[ -z $files ]] || compopt -o filenames 2>/dev/null
    for ending in $files; do
        case $ending in
        /) mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$cur") ;;
        '*') mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "$cur") ;;
        *)
            mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(
                compgen -f -X "!*.$ending" -- "$cur"
                compgen -f -X "!*.${ending^^}" -- "$cur")
            ;;
        esac
    done
}

_surfelao()
{
    local cur=${COMP_WORDS[COMP_CWORD]} command= word i takes= words= files=
    local -
    set -f  # endings are no patterns here
    COMPREPLY=()
    [[ $cur != = ]] || cur=
    for ((i = 1; i < COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        if [[ $word == = ]]; then
            continue
        elif [[ -z $command && $word != -* ]]; then
            command=$word takes= words= files=
        elif [[ $word == -[-a-zA-Z]* && " $words " != *" $word "* ]]; then
            _surfelao_table "$command" "$word"
        elif [[ $takes != several ]]; then
            takes= words= files=
        fi
    done
    if [[ -n $takes && $takes != optional && ($cur != -* || " $words" == *" $cur"*) ]]; then
        _surfelao_complete
        return
    fi
    _surfelao_table "$command"
    if [[ $cur == -* ]]; then
        files=
    elif [[ -n $command ]]; then
        words=
    fi
    _surfelao_complete
}
complete -F _surfelao surfelao
)";

std::string bash_files(const OptionFacts& option)
{
    if (!option.takes_files)
        return option.takes_folders ? "/" : "";
    return option.extensions.empty() ? "*" : "/ " + joined(option.extensions, " ");
}

std::string bash_option(const std::string& command, const OptionFacts& option)
{
    if (option.value.empty())
        return "";
    std::string line = "    ";
    for (const std::string& name : option.names)
        line.append(line == "    " ? "" : " | ").append("'" + command + " " + name + "'");
    line += std::string(") takes=") + (option.takes_several       ? "several"
                                       : option.is_optional_value ? "optional"
                                       : option.is_list           ? "list"
                                                                  : "one");
    if (!option.choices.empty())
        line += " words='" + joined(option.choices, " ") + "'";
    if (const std::string files = bash_files(option); !files.empty())
        line += " files='" + files + "'";
    return line + " ;;\n";
}

}  // namespace

std::string bash_completion(const std::vector<CommandFacts>& commands)
{
    std::string text = kBashHead;
    for (const CommandFacts& command : commands) {
        std::vector<std::string> words;
        std::string files, rows;
        for (const OptionFacts& option : command.options) {
            words.insert(words.end(), option.names.begin(), option.names.end());
            rows += bash_option(command.name, option);
        }
        for (const OptionFacts& argument : command.arguments)
            files = bash_files(argument);
        if (command.name.empty()) {
            for (std::size_t i = 1; i < commands.size(); ++i)
                words.push_back(commands[i].name);
        }
        text += "    '" + command.name + "') words='" + joined(words, " ") + "'" +
                (files.empty() ? "" : " files='" + files + "'") + " ;;\n" + rows;
    }
    return text + kBashTail;
}

}  // namespace surfelao
