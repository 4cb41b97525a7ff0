#include "bake/run_facts.h"

#include "bake/build_facts.h"
#include "surfels/number_text.h"

#include <sys/sysinfo.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <thread>

namespace surfelao {
namespace {

/// What stands behind `key` and a separator in a file of lines, without quotes.
std::string line_value(const char* path, const std::string& key)
{
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(key))
            continue;
        const std::size_t start = line.find_first_not_of(" \t:=\"", key.size());
        const std::size_t end = line.find_last_not_of("\" ");
        return start == std::string::npos ? "" : line.substr(start, end + 1 - start);
    }
    return {};
}

/// As it can be pasted into a shell.
std::string command_line()
{
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string text;
    for (std::string word; std::getline(file, word, '\0');) {
        const bool is_plain =
            !word.empty() && word.find_first_not_of(
                                 "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                 "_-+=./,:@%") == std::string::npos;
        std::string shown = word;
        if (!is_plain) {
            shown = "'";
            for (const char c : word)
                shown += c == '\'' ? std::string("'\\''") : std::string(1, c);
            shown += '\'';
        }
        text += (text.empty() ? "" : " ") + shown;
    }
    return text;
}

std::string date_text()
{
    std::time_t now = std::time(nullptr);
    if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH"))
        now = static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10));
    std::tm utc = {};
    gmtime_r(&now, &utc);
    char text[40];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
    return text;
}

std::string memory_text()
{
    struct sysinfo info = {};
    if (sysinfo(&info) != 0)
        return {};
    constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
    return significant(static_cast<double>(info.totalram) * info.mem_unit / kGiB, 3) + " GiB";
}

std::string system_text()
{
    std::string text = line_value("/etc/os-release", "PRETTY_NAME");
    utsname kernel = {};
    if (uname(&kernel) == 0)
        text += (text.empty() ? "" : ", ") + std::string(kernel.sysname) + ' ' + kernel.release +
                ", " + kernel.machine;
    return text;
}

std::string program_text()
{
    const BuildFacts& build = build_facts();
    std::string text = "surfelao " + std::string(build.version);
    if (!build.commit.empty())
        text.append(" (").append(build.commit).append(")");
    return text;
}

std::string value_of(const RunFacts& facts, std::string_view name)
{
    for (const auto& [known, value] : facts) {
        if (known == name)
            return value;
    }
    return {};
}

}  // namespace

RunFacts run_facts()
{
    RunFacts facts;
    const auto add = [&](const char* name, std::string value) {
        if (!value.empty())
            facts.emplace_back(name, std::move(value));
    };
    const auto join = [](const auto& words) {
        std::string text;
        for (const auto& word : words)
            text += (text.empty() ? "" : ", ") + word;
        return text;
    };
    const BuildFacts& build = build_facts();
    std::vector<std::string> libraries;
    for (const auto& [name, version] : build.libraries)
        libraries.push_back(std::string(name) + ' ' + std::string(version));
    add("program", program_text());
    add("command", command_line());
    add("date", date_text());
    add("processor", line_value("/proc/cpuinfo", "model name"));
    add("cores", count_text(std::thread::hardware_concurrency(), "core"));
    add("instructions", join(instruction_sets().usable));
    add("memory", memory_text());
    add("system", system_text());
    add("compiler", std::string(build.compiler) + ", " + std::string(build.build_type));
    add("libraries", join(libraries));
    return facts;
}

std::string citation_of(const RunFacts& facts)
{
    const std::string date = value_of(facts, "date");
    std::string text = value_of(facts, "program") + ", " + date.substr(0, date.find(' '));
    for (const char* name : {"processor", "cores"}) {
        if (const std::string value = value_of(facts, name); !value.empty())
            text += ", " + value;
    }
    return text;
}

}  // namespace surfelao
