// stability: every hard case through every engine, as one table on stdout.
//
//     stability [--quick] [--json FILE] [TEXT...]
//
//     --quick: without the slow cases; --json: the table as a file, too; TEXT: only cases whose
//     group or name contains one of the texts
//
// Exit 0: all within their bounds; 1: at least one FAIL; 2: wrong usage.
#include "tests/stability/engines.h"
#include "tests/stability/judge.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

using namespace surfelao::stability;

namespace {

using Json = nlohmann::ordered_json;

struct Options {
    bool quick = false;
    std::string json;  ///< empty: none
    std::vector<std::string> texts;
};

struct Totals {
    std::size_t verdicts[4] = {};
    Bound worst;  ///< over the cases that the engine is held to
    std::string worst_case;
};

constexpr std::size_t kColumns =
    8;  ///< the other engines, which ask few receivers, follow in a table of their own
constexpr const char* kNotRun = "      -     -  ";

char mark(Verdict verdict)
{
    return " ~?!"[static_cast<int>(verdict)];
}

bool asked_for(const Case& item, const std::vector<std::string>& texts)
{
    return texts.empty() || std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
               return (item.group + ": " + item.name).find(text) != std::string::npos;
           });
}

const char* source_of(const World& world)
{
    return world.like ? "like" : world.answer ? "form" : "rays";
}

void print_header(std::span<const Engine> engines)
{
    std::printf("%-52s %5s %6s %5s", "case", "truth", "points", "undef");
    for (const Engine& engine : engines)
        std::printf("  %-13s", engine.name.c_str());
    std::printf("\n%-52s %5s %6s %5s", "bound (rms worst)", "", "", "");
    for (const Engine& engine : engines)
        std::printf("  %5.3f %5.3f  ", engine.bound.rms, engine.bound.worst);
    std::printf("\n");
}

std::string title_of(const Case& item, const Trial& trial)
{
    char text[120];
    std::snprintf(text, sizeof text, "%-52s %5s %6zu %5zu", (item.group + ": " + item.name).c_str(),
                  source_of(trial.world), trial.world.receivers.size(), trial.undefined);
    return text;
}

std::string cell_of(const Finding& finding)
{
    char text[40];
    std::snprintf(text, sizeof text, "  %5.3f %5.3f %c", finding.error.rms, finding.error.worst,
                  mark(finding.verdict));
    return text;
}

void print_summary(const std::vector<Engine>& engines, const std::vector<Totals>& totals)
{
    std::printf("\n%-14s %5s %8s %10s %5s  %s\n", "engine", "pass", "excused", "undefined", "FAIL",
                "worst error where held to a bound");
    for (std::size_t e = 0; e < engines.size(); ++e) {
        const Totals& t = totals[e];
        std::printf("%-14s %5zu %8zu %10zu %5zu  rms %.4f, worst %.4f (%s)\n",
                    engines[e].name.c_str(), t.verdicts[0], t.verdicts[1], t.verdicts[2],
                    t.verdicts[3], t.worst.rms, t.worst.worst, t.worst_case.c_str());
    }
}

/// [rms, worst, mark]; nothing where the engine was not run.
Json json_of(const Finding& finding, bool skipped)
{
    const char letter = mark(finding.verdict);
    return skipped ? Json()
                   : Json{finding.error.rms, finding.error.worst,
                          letter == ' ' ? std::string() : std::string(1, letter)};
}

/// Keys group, name, truth, points, undefined; errors of all engines in their order.
Json json_of(const Case& item, const Trial& trial, Json errors)
{
    return {{"group", item.group},
            {"name", item.name},
            {"truth", source_of(trial.world)},
            {"points", trial.world.receivers.size()},
            {"undefined", trial.undefined},
            {"errors", std::move(errors)}};
}

void write_json(const std::string& path, const std::vector<Engine>& engines,
                const std::vector<Totals>& totals, const Json& cases)
{
    Json list = Json::array();
    for (std::size_t e = 0; e < engines.size(); ++e) {
        const Totals& t = totals[e];
        list.push_back({{"name", engines[e].name},
                        {"bound_rms", engines[e].bound.rms},
                        {"bound_worst", engines[e].bound.worst},
                        {"pass", t.verdicts[0]},
                        {"excused", t.verdicts[1]},
                        {"undefined", t.verdicts[2]},
                        {"fail", t.verdicts[3]},
                        {"largest_rms", t.worst.rms},
                        {"largest_worst", t.worst.worst},
                        {"worst_case", t.worst_case}});
    }
    std::ofstream file(path);
    file << Json{{"engines", list}, {"cases", cases}}.dump(1) << '\n';
    file.close();
    if (!file)
        throw std::runtime_error("cannot write " + path);
}

int run(const Options& options)
{
    const std::vector<Engine> engines = all_engines();
    std::vector<Totals> totals(engines.size());
    std::vector<std::string> faults;
    std::size_t receivers = 0, undefined = 0;
    Json cases = Json::array();

    const std::span<const Engine> shown = std::span(engines).first(kColumns);
    const std::span<const Engine> others = std::span(engines).subspan(kColumns);
    std::string table_of_others;
    print_header(shown);
    for (const Case& item : all_cases()) {
        if ((options.quick && item.slow) || !asked_for(item, options.texts))
            continue;
        const std::string title = item.group + ": " + item.name;
        const Trial trial = prepare(item.make());
        const Trial few = thinned(trial, kFewReceivers);
        Built built;
        std::fputs(title_of(item, trial).c_str(), stdout);
        table_of_others += title_of(item, few);
        Json errors = Json::array();
        for (std::size_t e = 0; e < engines.size(); ++e) {
            const bool skipped = item.slow && engines[e].skips_slow;
            const Finding finding = skipped ? Finding()
                                            : judge(engines[e].asks_few ? few : trial, engines[e],
                                                    item.disks_excused, built);
            const std::string cell = skipped ? kNotRun : cell_of(finding);
            if (e < kColumns)
                std::fputs(cell.c_str(), stdout);
            else
                table_of_others += cell;
            std::fflush(stdout);
            errors.push_back(json_of(finding, skipped));
            if (skipped)
                continue;
            Totals& total = totals[e];
            ++total.verdicts[static_cast<int>(finding.verdict)];
            if (finding.verdict == Verdict::fail)
                faults.push_back(title + ", " + engines[e].name + ": " + finding.fault);
            if (finding.verdict != Verdict::excused) {
                total.worst.rms = std::max(total.worst.rms, finding.error.rms);
                if (finding.error.worst > total.worst.worst) {
                    total.worst.worst = finding.error.worst;
                    total.worst_case = title;
                }
            }
        }
        std::printf("\n");
        table_of_others += '\n';
        cases.push_back(json_of(item, trial, std::move(errors)));
        receivers += trial.world.receivers.size();
        undefined += trial.undefined;
    }
    std::printf("\n");
    print_header(others);
    std::fputs(table_of_others.c_str(), stdout);
    print_summary(engines, totals);
    std::printf(
        "\n%zu cases, %zu receivers, of which %zu have no answer by the definition "
        "(reference/well_defined.h)\n",
        cases.size(), receivers, undefined);
    if (!options.json.empty())
        write_json(options.json, engines, totals, cases);
    for (const std::string& fault : faults)
        std::printf("FAIL %s\n", fault.c_str());
    return faults.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--quick") == 0) {
            options.quick = true;
        } else if (std::strcmp(argv[i], "--json") == 0 && i + 1 < argc) {
            options.json = argv[++i];
        } else if (argv[i][0] == '-') {
            std::fprintf(stderr, "usage: stability [--quick] [--json FILE] [TEXT...]\n");
            return 2;
        } else {
            options.texts.emplace_back(argv[i]);
        }
    }
    try {
        return run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "stability: %s\n", error.what());
        return 1;
    }
}
