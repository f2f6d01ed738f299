// A child process that does some work and exchanges messages with its parent. A crash, a hang,
// exit(), output or a changed floating-point mode of the child does not affect the parent.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "harness/core/result.hpp"
#include "harness/process/barrier.hpp"
#include "harness/process/message_socket.hpp"
#include "harness/process/process.hpp"
#include "harness/process/tree_usage.hpp"

namespace attest {

// The descriptors that a child keeps.
struct ChildFiles {
  int input;   // for stdin: /dev/null
  int output;  // for stdout and stderr; a file in memory
  int socket;  // the child's end of the socket pair
};

// Limits of a child that runs code of others. A build with sanitizers does not limit the memory.
inline constexpr int max_memory_gib = 4, max_file_mib = 16, max_open_files = 1024;
bool memory_is_limited();

class Child {
 public:
  enum class Runs { our_code, code_of_others };
  using Work = std::function<void(MessageSocket&)>;

  // Forks a child (a Process), which runs `work` and then ends. Its stdout and stderr are captured
  // (last_words), its stdin is empty, and it has no descriptors of the parent. Code of others runs
  // behind the barrier, and has limits that it cannot raise: of memory, of the number of open
  // files, and of the size of each file that it writes, including its output.
  static Result<Child> spawn(Runs runs, const Work& work, const BarrierOptions& barrier = {});

  // Same as spawn(), but `launch` starts the process and makes it call run_in_child() with the
  // given files. `launch` must not close these files.
  static Result<Child> adopt(const std::function<Result<Process>(const ChildFiles&)>& launch);

  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  ~Child();  // kills and reaps the child

  // The socket to the child's `work`, for sending.
  MessageSocket& socket() { return socket_; }

  // Same as in MessageSocket, but both also return `ended` when the child has died. The socket
  // alone does not show this: a process that the child started may keep the child's end open.
  Received receive(const Patience& patience = {});
  Received::Kind receive_blob(void* place, std::size_t size, const Patience& patience = {});

  TreeUsage usage() const { return usage_of_tree(process_.pid()); }

  void wake() { process_.wake(); }
  void kill() { process_.kill(); }
  bool was_killed() const { return process_.was_killed(); }

  // Waits up to two seconds for the end, and returns Ending::to_string(). A child that still runs
  // then is killed, and the text is "closed the socket on which it answers, and went on". REQUIRES:
  // the child was killed, or its socket has ended.
  std::string end();

  // After end(): the child exited by itself, with status 0.
  bool has_exited_well() const { return has_exited_well_; }

  // The bytes that the child has printed on stdout and stderr so far.
  std::size_t printed() const;
  // last_words_in() of what it printed after the first `from` bytes.
  std::string last_words(std::size_t from = 0) const;
  std::string last_printed() const;  // "; it last printed: LAST WORDS", or empty

 private:
  Child(Process process, MessageSocket socket, int output)
      : process_(std::move(process)), socket_(std::move(socket)), output_(output) {}

  Process process_;
  MessageSocket socket_;
  int output_ = -1;  // file that holds what the child prints
  bool has_exited_well_ = false;
};

// Called in the new child: closes all files except `files`, does the work, and ends the process.
// With a barrier the work is code of others.
[[noreturn]] void run_in_child(const Barrier* barrier, const ChildFiles& files,
                               const Child::Work& work);

// The line of the last panic in a text that a program printed (of Rust, Go or a sanitizer), with
// its message; if there is none, the last line. At most 400 bytes. Empty: the text is blank.
std::string last_words_in(std::string_view text);

}  // namespace attest
