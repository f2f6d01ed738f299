// Ctrl-C and SIGTERM end a run cleanly: workers are stopped, readers stop reading, and incomplete
// files are removed. The flag belongs to the process, because signals do.
#pragma once

namespace attest {

// From now on the first SIGINT and the first SIGTERM only set interrupted(). The second signal of
// the same kind ends the process.
void note_interrupts();

bool interrupted();

// For a caller that goes on, such as with the reports of a run of which only the diagnosis was
// interrupted.
void forget_interrupt();

}  // namespace attest
