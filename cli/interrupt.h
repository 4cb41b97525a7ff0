/// interrupt.h: Ctrl-C and its relatives.
#pragma once

namespace surfelao {

/// From now on SIGINT, SIGTERM and SIGHUP are remembered, and the work at hand ends at its next
/// progress report. A second one ends the process at once, without its temporary files.
void interrupt_politely();

/// The signal that came; 0 while none has.
[[nodiscard]] int caught_signal();

}  // namespace surfelao
