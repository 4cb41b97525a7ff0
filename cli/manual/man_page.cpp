#include "cli/manual/man_page.h"

#include <cctype>

namespace surfelao {
namespace {

/// A sign as troff takes it.
std::string escaped(char c)
{
    return c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
}

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text)
        result += escaped(c);
    return result;
}

/// Sentences. `quoted` words and --options are bold.
std::string prose(const std::string& text)
{
    std::string result;
    bool quoted = false, in_option = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool in_name = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
        if (in_option && !in_name) {
            result += "\\fR";
            in_option = false;
        }
        if (!quoted && !in_option && text.compare(i, 2, "--") == 0 &&
            (i == 0 || text[i - 1] == ' ' || text[i - 1] == '(')) {
            result += "\\fB";
            in_option = true;
        }
        if (c == '`') {
            quoted = !quoted;
            result += quoted ? "\\fB" : "\\fR";
        } else {
            if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n'))
                result += "\\&";  // else a request
            result += escaped(c);
        }
    }
    return result + (in_option ? "\\fR" : "");
}

std::string bold(const std::string& text)
{
    return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text)
{
    return "\\fI" + escaped(text) + "\\fR";
}

std::string named(const CommandFacts& command)
{
    return command.name.empty() ? "surfelao" : "surfelao " + command.name;
}

std::string sentence(std::string text)
{
    if (!text.empty() && text.back() != '.')
        text += '.';
    return text;
}

/// "-o, --output OUT|DIR"
std::string head_of(const OptionFacts& option)
{
    std::string head;
    for (const std::string& name : option.names)
        head.append(head.empty() ? "" : ", ").append(bold(name));
    if (option.names.empty())
        return italic(option.value) + (option.takes_several ? "..." : "");
    if (!option.value.empty())
        head += ' ' + italic(option.value);
    if (option.takes_several && option.value.find("...") == std::string::npos)
        head += "...";
    return head;
}

/// Whether it must be given, its choices, range and default, and what it does not go with.
std::string rules_of(const OptionFacts& option)
{
    std::vector<std::string> rules;
    const std::string choices = joined(option.choices, ", ");
    if (option.is_required)
        rules.emplace_back("Required.");
    // where the heading does not show them
    if (!choices.empty() && option.value.find(joined(option.choices, "|")) == std::string::npos)
        rules.push_back("One of " + choices + ".");
    if (!option.range.empty())
        rules.push_back("In the range " + option.range + ".");
    if (!option.standard.empty())
        rules.push_back("Default: " + sentence(option.standard));
    if (!option.needs.empty())
        rules.push_back("Only with " + joined(option.needs, ", ") + ".");
    if (!option.excludes.empty())
        rules.push_back("Not with " + joined(option.excludes, ", ") + ".");
    return joined(rules, " ");
}

std::string entry_of(const OptionFacts& option)
{
    std::string text = ".TP\n" + head_of(option) + "\n" + prose(sentence(option.about)) + "\n";
    const std::string rules = rules_of(option);
    if (!rules.empty())
        text += prose(rules) + "\n";
    return text;
}

std::string synopsis_of(const CommandFacts& command)
{
    std::string text = bold(named(command)) + "\n[" + italic("OPTION") + "]...";
    if (command.name.empty())
        return text + "\n" + italic("COMMAND") + "\n[" + italic("ARGUMENT") + "]...\n";
    for (const OptionFacts& argument : command.arguments) {
        const std::string head = head_of(argument);
        text += "\n" + (argument.is_required ? head : "[" + head + "]");
    }
    for (const OptionFacts& option : command.options) {
        if (option.is_required)
            text += "\n" + bold(option.names.front()) + " " + italic(option.value);
    }
    return text + "\n";
}

std::string options_of(const CommandFacts& command)
{
    std::string text = ".SH OPTIONS\n";
    std::vector<std::string> groups;
    for (const OptionFacts& option : command.options) {
        bool is_new = true;
        for (const std::string& group : groups)
            is_new = is_new && group != option.group;
        if (is_new)
            groups.push_back(option.group);
    }
    for (const std::string& group : groups) {
        if (groups.size() > 1 && group != "Options")
            text += ".SS " + prose(group) + "\n";
        for (const OptionFacts& option : command.options) {
            if (option.group == group)
                text += entry_of(option);
        }
    }
    return text;
}

std::string paragraphs(const std::string& lines)
{
    return prose(sentence(lines)) + "\n";
}

}  // namespace

std::string page_name(const CommandFacts& command)
{
    return command.name.empty() ? "surfelao" : "surfelao-" + command.name;
}

std::string man_page(const std::vector<CommandFacts>& commands, std::size_t index,
                     const std::string& version, const std::string& date)
{
    const CommandFacts& command = commands[index];
    std::string title = page_name(command);
    for (char& c : title)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string text = ".\\\" made from the program's table of options\n";
    text += ".TH " + title + " 1 " + date + " \"surfelao " + version + "\" \"surfelao manual\"\n";
    text += ".SH NAME\n" + escaped(page_name(command)) + " \\- " +
            prose(short_text(command.about)) + "\n.SH SYNOPSIS\n" + synopsis_of(command) +
            ".SH DESCRIPTION\n" + paragraphs(command.about);
    if (!command.footer.empty())
        text += ".PP\n" + paragraphs(command.footer);
    if (!command.arguments.empty()) {
        text += ".SH ARGUMENTS\n";
        for (const OptionFacts& argument : command.arguments)
            text += entry_of(argument);
    }
    if (command.name.empty()) {
        text += ".SH COMMANDS\n";
        for (std::size_t i = 1; i < commands.size(); ++i)
            text += ".TP\n" + bold(page_name(commands[i])) + "(1)\n" +
                    prose(sentence(commands[i].about)) + "\n";
    }
    std::vector<std::string> others;
    for (std::size_t i = 0; i < commands.size(); ++i) {
        if (i != index)
            others.push_back(".BR " + escaped(page_name(commands[i])) + " (1)");
    }
    return text + options_of(command) + ".SH SEE ALSO\n" + joined(others, ",\n") +
           "\n.PP\nThe pages in\n.I /usr/share/doc/surfelao\n";
}

}  // namespace surfelao
