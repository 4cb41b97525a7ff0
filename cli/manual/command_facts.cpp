#include "cli/manual/command_facts.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <functional>
#include <set>
#include <string_view>

namespace surfelao {
namespace {

bool is_letter(char c)
{
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool is_word_sign(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

std::vector<std::string> split(std::string_view text, char between)
{
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == between)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

void add_new(std::vector<std::string>& words, const std::string& word)
{
    if (!word.empty() && std::find(words.begin(), words.end(), word) == words.end())
        words.push_back(word);
}

/// What each check of an option says of itself.
std::vector<std::string> checks_of(CLI::Option& option)
{
    std::vector<std::string> texts;
    try {
        for (int i = 0;; ++i)  // the table tells no count
            texts.push_back(option.get_validator(i)->get_description());
    } catch (const CLI::OptionNotFound&) {
    }
    std::erase(texts, "");
    return texts;
}

/// A value to be written as it stands: "cpu", "+y", "16"; not "N", "X:Y:Z", "[H]".
bool is_literal(const std::string& word)
{
    return !word.empty() && std::none_of(word.begin(), word.end(), [](char c) {
        return std::isupper(static_cast<unsigned char>(c)) != 0 || c == '[' || c == ':' || c == '.';
    });
}

/// "ply" and "glb" of "(.ply, .glb)"
std::vector<std::string> extensions_in(const std::string& text)
{
    std::vector<std::string> found;
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
        const bool starts_word = i == 0 || (!is_word_sign(text[i - 1]) && text[i - 1] != '.');
        if (text[i] != '.' || !starts_word || !is_letter(text[i + 1]))
            continue;
        std::size_t end = i + 1;
        while (end < text.size() && is_word_sign(text[end]))
            ++end;
        add_new(found, text.substr(i + 1, end - i - 1));
    }
    return found;
}

bool has_word(const std::string& text, const std::set<std::string>& words)
{
    std::string word;
    for (const char c : text + " ") {
        if (is_letter(c)) {
            word += c;
            continue;
        }
        if (words.count(word) != 0)
            return true;
        word.clear();
    }
    return false;
}

std::vector<std::string> names_of(const std::set<CLI::Option*>& options)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : options)
        names.push_back(option->get_name());
    std::sort(names.begin(), names.end());  // the set is in the order of addresses
    return names;
}

void read_value(CLI::Option& option, OptionFacts& facts)
{
    const std::vector<std::string> checks = checks_of(option);
    facts.value = option.get_type_name();  // and behind it the checks
    for (const std::string& check : checks)
        facts.value.erase(facts.value.size() - check.size() - 1);
    if (facts.names.empty())
        facts.value = option.get_single_name();

    for (const std::string& word : split(facts.value, '|')) {
        if (is_literal(word))
            add_new(facts.choices, word);
    }
    for (const std::string& check : checks) {
        if (check.front() == '{' && check.back() == '}') {
            for (const std::string& word : split(check.substr(1, check.size() - 2), ','))
                add_new(facts.choices, word);
        } else {
            facts.range = check;
        }
    }
    facts.takes_files = has_word(facts.value, {"FILE", "OUT", "IN", "PART"});
    facts.takes_folders = has_word(facts.value, {"DIR"});
    if (facts.takes_files)
        facts.extensions = extensions_in(facts.about);
    facts.is_optional_value = option.get_expected_min() == 0;
    facts.is_list = option.get_delimiter() == ',';
    facts.takes_several = option.get_items_expected_max() > 1 && option.get_allow_extra_args();
}

OptionFacts option_facts(CLI::Option& option)
{
    OptionFacts facts;
    for (const std::string& name : option.get_snames())
        facts.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames())
        facts.names.push_back("--" + name);
    facts.about = option.get_description();
    facts.group = option.get_group();
    facts.standard = option.get_default_str();
    facts.is_required = option.get_required();
    facts.excludes = names_of(option.get_excludes());
    facts.needs = names_of(option.get_needs());
    if (option.get_items_expected_max() > 0)
        read_value(option, facts);
    return facts;
}

CommandFacts command_facts(CLI::App& app)
{
    CommandFacts facts;
    facts.about = app.get_description();
    facts.footer = app.get_footer();
    for (CLI::Option* option : app.get_options()) {
        OptionFacts one = option_facts(*option);
        if (one.group.empty())
            continue;  // hidden
        (one.names.empty() ? facts.arguments : facts.options).push_back(std::move(one));
    }
    return facts;
}

}  // namespace

std::vector<CommandFacts> facts_of(CLI::App& app)
{
    std::vector<CommandFacts> commands = {command_facts(app)};
    for (CLI::App* command : app.get_subcommands(std::function<bool(CLI::App*)>())) {
        commands.push_back(command_facts(*command));
        commands.back().name = command->get_name();
    }
    return commands;
}

std::string joined(const std::vector<std::string>& words, const char* between)
{
    std::string text;
    for (const std::string& word : words)
        text.append(text.empty() ? "" : between).append(word);
    return text;
}

std::string short_text(const std::string& about)
{
    constexpr std::size_t kMost = 70;
    std::size_t end = std::min(about.find('\n'), about.size());
    for (const char* stop : {". ", "; "})
        end = std::min(end, about.find(stop));
    if (end > kMost)  // at the end of a clause, or where there is none, of a word
        end = about.find_last_of(",:", kMost) + 1;
    if (end == 0)
        end = std::min(about.rfind(' ', kMost), kMost);
    if (const std::size_t open = about.rfind('(', end);
        open != std::string::npos && about.find(')', open) >= end)
        end = open;
    while (end > 0 && std::string_view(" .,:;(").find(about[end - 1]) != std::string_view::npos)
        --end;
    return about.substr(0, end);
}

}  // namespace surfelao
