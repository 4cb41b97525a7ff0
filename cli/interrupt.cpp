#include "cli/interrupt.h"

#include "cli/commands.h"
#include "surfels/atomic_file.h"

#include <signal.h>
#include <unistd.h>

namespace surfelao {
namespace {

volatile sig_atomic_t caught = 0;

extern "C" void on_signal(int signal)
{
    if (caught != 0) {
        remove_temporary_files();
        _exit(kKilledBy + signal);
    }
    caught = signal;
}

}  // namespace

void interrupt_politely()
{
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN)  // nohup, and shells that start jobs in the background
            sigaction(signal, &action, nullptr);
    }
}

int caught_signal()
{
    return caught;
}

}  // namespace surfelao
