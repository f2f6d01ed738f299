// A child process that does some work and answers in lines over a pipe. Whatever a port does in
// there (crash, hang, exit, print, change the floating point mode) stays in there.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/process/process.hpp"

namespace attest {

// What a child may use. A build with sanitizers does not limit the memory.
inline constexpr int max_memory_gib = 4, max_file_mib = 16;
bool memory_is_limited();

// Sends one line (without its end) to the parent. In the child only.
using SendLine = std::function<void(const std::string& line)>;

// What a child prints is bounded, and with it each file it writes. For work that writes files of
// its own, once the port has nothing more to say.
void allow_large_files();

class Child {
 public:
  // Forks; `work` runs in the child, a Process, which then ends. Its stdout and stderr are kept
  // apart (last_words), its stdin is empty, and of the parent's descriptors it has none.
  static Result<Child> spawn(const std::function<void(const SendLine&)>& work);

  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  ~Child();  // kills and reaps

  // Readable when the child sent something or ended. For poll().
  int descriptor() const { return pipe_; }

  // The complete lines that have arrived; sets `ended` when the child closed its end.
  std::vector<std::string> read_lines(bool& ended);

  // The first line it sends; empty when it ended, or said nothing until the time is over or
  // `stop` says so (then it is killed).
  std::optional<std::string> wait_for_line(
      double timeout_s, const std::function<bool()>& stop = [] { return false; });

  void kill() { process_.kill(); }  // with all that it started
  bool was_killed() const { return process_.was_killed(); }

  void ask_to_stop() { process_.terminate(); }  // SIGTERM, for work that has arranged for it

  // How it ended, as Ending::to_string() says. For a child that was killed or whose pipe has ended:
  // it has two seconds to end by itself; one that goes on without its pipe is killed, and called
  // so.
  std::string end();

  // The last line that the child printed on stdout or stderr; empty when it printed nothing.
  std::string last_words() const;

 private:
  Child(Process process, int pipe, int output)
      : process_(std::move(process)), pipe_(pipe), output_(output) {}
  void close_files();

  Process process_;
  int pipe_ = -1;
  int output_ = -1;  // file that holds what the child prints
  std::string partial_;
};

}  // namespace attest
