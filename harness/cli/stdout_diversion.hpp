// Keeps the text that a port prints out of attest's own stdout.
#pragma once

namespace attest::cli {

// With --in-process, a port shares the stdout of attest. Until end(), all that is written on stdout
// goes to stderr, so that reports on stdout have no text of the port. At most one at a time.
class StdoutDiversion {
 public:
  explicit StdoutDiversion(bool is_wanted);
  ~StdoutDiversion() { end(); }
  StdoutDiversion(const StdoutDiversion&) = delete;
  StdoutDiversion& operator=(const StdoutDiversion&) = delete;

  void end();

 private:
  int stdout_ = -1;  // a copy of the descriptor; -1: not diverted
};

}  // namespace attest::cli
