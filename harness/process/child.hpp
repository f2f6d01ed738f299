// A child process that does some work and sends messages. It contains a crash, a hang, exit(),
// output and a changed floating point mode: the parent is not affected.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "harness/core/result.hpp"
#include "harness/process/message_socket.hpp"
#include "harness/process/process.hpp"

namespace attest {

// The descriptors that a child keeps.
struct ChildFiles {
  int input;   // for stdin; there is nothing to read
  int output;  // for stdout and stderr; a file in memory
  int socket;  // the child's end
};

// Limits of a child that runs code of others. A build with sanitizers does not limit the memory.
inline constexpr int max_memory_gib = 4, max_file_mib = 16;
bool memory_is_limited();

class Child {
 public:
  enum class Runs { our_code, code_of_others };
  using Work = std::function<void(MessageSocket&)>;

  // Forks a child (a Process), which runs `work` and then ends. Its stdout and stderr are captured
  // (last_words), its stdin is empty, and it has no descriptors of the parent. Code of others also
  // has limits: of memory, and of the size of each file that it writes, including its output.
  static Result<Child> spawn(Runs runs, const Work& work);

  // Same, for a process that `launch` starts. `launch` must make that process call run_in_child()
  // with the files that it is given, and must not close them.
  static Result<Child> adopt(const std::function<Result<Process>(const ChildFiles&)>& launch);

  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  ~Child();  // kills and reaps

  // The socket to the child's `work`, for sending.
  MessageSocket& socket() { return socket_; }

  // Same as in MessageSocket. Both also return `ended` when the child has died, because a process
  // started by the child may keep the child's side of the socket open.
  Received receive(const Patience& patience = {});
  Received::Kind receive_blob(void* place, std::size_t size, const Patience& patience = {});

  void kill() { process_.kill(); }  // with its process group
  bool was_killed() const { return process_.was_killed(); }

  void ask_to_stop() { process_.terminate(); }  // SIGTERM, for work that handles it

  // Waits for the end, and returns the text of Ending::to_string(). After two seconds a child that
  // still runs is killed, and the text reports that. REQUIRES: the child was killed, or its socket
  // has ended.
  std::string end();

  // After end(): it exited by itself, with status 0.
  bool has_exited_well() const { return has_exited_well_; }

  // The last line that the child printed on stdout or stderr; empty when it printed nothing.
  std::string last_words() const;
  std::string last_printed() const;  // "; it last printed: LAST WORDS", or empty

 private:
  Child(Process process, MessageSocket socket, int output)
      : process_(std::move(process)), socket_(std::move(socket)), output_(output) {}

  Process process_;
  MessageSocket socket_;
  int output_ = -1;  // file that holds what the child prints
  bool has_exited_well_ = false;
};

// Called in the new child: keeps the files, closes all others, and does the work. Does not return.
[[noreturn]] void run_in_child(Child::Runs runs, const ChildFiles& files, const Child::Work& work);

}  // namespace attest
