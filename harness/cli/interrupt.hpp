// Ctrl-C and SIGTERM end a run cleanly: workers are stopped, files half written are removed.
#pragma once

namespace attest::cli {

// From now on the signals are noted instead of ending the process at once. A second one does.
void note_interrupts();

bool interrupted();

}  // namespace attest::cli
