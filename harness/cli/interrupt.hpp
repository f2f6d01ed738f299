// Ctrl-C and SIGTERM end a run cleanly: workers are stopped, files half written are removed.
#pragma once

namespace attest::cli {

// From now on the first signal of each kind is only noted; the second one ends the process.
void note_interrupts();

bool interrupted();

}  // namespace attest::cli
