// Ctrl-C and SIGTERM end a run cleanly: workers are stopped, and incomplete files are removed.
#pragma once

namespace attest::cli {

// From now on the first SIGINT and the first SIGTERM only set interrupted(). The second signal of
// the same kind ends the process.
void note_interrupts();

bool interrupted();

}  // namespace attest::cli
