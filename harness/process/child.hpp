// A child process that does some work and answers in messages. Whatever goes on in there (a crash,
// a hang, exit(), output, a changed floating point mode) stays in there.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "harness/core/result.hpp"
#include "harness/process/message_socket.hpp"
#include "harness/process/process.hpp"

namespace attest {

// What a child that runs code of others may use. A build with sanitizers does not limit the memory.
inline constexpr int max_memory_gib = 4, max_file_mib = 16;
bool memory_is_limited();

class Child {
 public:
  enum class Runs { our_code, code_of_others };

  // Forks; `work` runs in the child, a Process, which then ends. Its stdout and stderr are kept
  // apart (last_words), its stdin is empty, and of the parent's descriptors it has none. Code of
  // others has limits besides: of memory, and of each file it writes, which bounds what it prints.
  static Result<Child> spawn(Runs runs, const std::function<void(MessageSocket&)>& work);

  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  ~Child();  // kills and reaps

  // To the child's `work`, for sending.
  MessageSocket& socket() { return socket_; }

  // Same as MessageSocket. Also ends when the child has died, because a process that it started may
  // keep its end open.
  Received receive(const Patience& patience = {});
  Received::Kind receive_blob(void* place, std::size_t size, const Patience& patience = {});

  void kill() { process_.kill(); }  // with all that it started
  bool was_killed() const { return process_.was_killed(); }

  void ask_to_stop() { process_.terminate(); }  // SIGTERM, for work that has arranged for it

  // How it ended, as Ending::to_string() says. For a child that was killed or whose socket has
  // ended: it has two seconds to end by itself. If it still runs then, it is killed, and the text
  // says so.
  std::string end();

  // After end(): it exited by itself, with status 0.
  bool has_exited_well() const { return has_exited_well_; }

  // The last line that the child printed on stdout or stderr; empty when it printed nothing.
  std::string last_words() const;

 private:
  Child(Process process, MessageSocket socket, int output)
      : process_(std::move(process)), socket_(std::move(socket)), output_(output) {}

  Process process_;
  MessageSocket socket_;
  int output_ = -1;  // file that holds what the child prints
  bool has_exited_well_ = false;
};

}  // namespace attest
