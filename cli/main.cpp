#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/usage_sentence.h"
#include "surfels/errors.h"
#include "surfels/heap_pages.h"
#include "surfels/progress.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <new>

namespace surfelao {
namespace {

int run(int argument_count, char** arguments)
{
    keep_heap_pages();
    CLI::App app;
    Work work;
    add_commands(app, work);
    if (argument_count == 1) {
        std::cerr << app.help();
        return kWrongUsage;
    }
    try {
        app.parse(argument_count, arguments);
    } catch (const CLI::Success& asked) {  // --help, --version
        return app.exit(asked);
    } catch (const CLI::ParseError& error) {
        throw UsageError(usage_sentence(app, error));
    }
    interrupt_politely();
    const int code = work();
    std::cout.flush();
    if (!std::cout)
        throw std::runtime_error("the results could not be written to standard output");
    return code;
}

}  // namespace
}  // namespace surfelao

/// Exceptions end here and nowhere else.
int main(int argument_count, char** arguments)
{
    using namespace surfelao;
    const auto say = [](const char* what) { std::cerr << "surfelao: " << what << '\n'; };
    try {
        return run(argument_count, arguments);
    } catch (const UsageError& error) {
        say(error.what());
        return kWrongUsage;
    } catch (const SettingsError& error) {  // settings that are not for this file
        say(error.what());
        return kWrongUsage;
    } catch (const Cancelled&) {
        say("interrupted; the unfinished result was not written");
        return kKilledBy + caught_signal();
    } catch (const std::bad_alloc&) {
        say("not enough memory");
    } catch (const std::exception& error) {
        say(error.what());
    }
    return kFailed;
}
