#include "cli/usage_sentence.h"

#include "cli/did_you_mean.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

bool is_option(std::string_view word)
{
    return word.size() > 1 && word.front() == '-';
}

/// "--quality" of "--quality=best"
std::string name_in(const std::string& word)
{
    return word.substr(0, word.find('='));
}

/// As the command's help calls it: "IN", "-o OUT|DIR".
std::string shown(const CLI::Option& option)
{
    if (option.get_positional())
        return option.get_name();
    const std::vector<std::string>& letters = option.get_snames();
    return (letters.empty() ? option.get_name() : '-' + letters.front()) + ' ' +
           option.get_type_name();
}

std::string ask_help(const CLI::App& command)
{
    return "; surfelao help " + command.get_name() + " lists what there is.";
}

std::string unknown_option(const CLI::App& command, const std::string& word)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    const std::string name = name_in(word);
    return command.get_name() + " has no option " + name +
           did_you_mean(name, names, ask_help(command));
}

/// What the program itself does not know: there is no command yet.
std::string before_the_command(const CLI::App& app, const std::string& word)
{
    std::error_code error;
    if (std::filesystem::exists(word, error))
        return '"' + word + "\" is a file: a command stands before it, as in surfelao bake " +
               word + " -o OUT or surfelao view " + word + '.';
    return is_option(word) ? name_in(word) + ": options stand behind the command, as in surfelao " +
                                 "bake IN -o OUT " + name_in(word) + '.'
                           : no_command_sentence(app, word);
}

std::string missing(const CLI::App& command)
{
    std::string all;
    for (const CLI::Option* option : command.get_options())
        if (option->get_required() && option->count() == 0)
            all += (all.empty() ? "" : " and ") + shown(*option);
    return command.get_name() + " needs " + all + ask_help(command);
}

/// Of an option that has too many values, or too few.
std::string mismatch(const CLI::App& command, const std::string& what)
{
    std::string name = what.substr(0, what.find_first_of(": "));
    if (!is_option(name))  // flags are named without
        name.insert(0, "--");
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr)
        return what + '.';
    if (option->get_items_expected_max() == 0)
        return name + " takes no value.";
    if (option->count() > 1)
        return name + " is given " + std::to_string(option->count()) +
               " times: it has one value only.";
    return name + " needs a value: " + option->get_type_name() + '.';
}

}  // namespace

std::string no_command_sentence(const CLI::App& app, const std::string& word)
{
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({}))
        names.push_back(command->get_name());
    return '"' + word + "\" is no command" +
           did_you_mean(word, names, "; surfelao help lists what there is.");
}

std::string usage_sentence(const CLI::App& app, const CLI::ParseError& error)
{
    if (const auto words = app.remaining(); !words.empty())
        return before_the_command(app, words.front());
    if (app.get_subcommands().empty())
        return std::string(error.what()) + '.';
    const CLI::App& command = *app.get_subcommands().front();
    const std::vector<std::string> words = command.remaining();
    if (const auto option = std::ranges::find_if(words, is_option); option != words.end())
        return unknown_option(command, *option);
    if (!words.empty())
        return command.get_name() + ": \"" + words.front() + "\" is one file too many.";
    const std::string what = error.what();
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
        return missing(command);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
        return mismatch(command, what);
    return what.ends_with('?') ? what : what + '.';
}

}  // namespace surfelao
