// A program that reads requests on stdin and answers on stdout. Both are pipes to this process; its
// stderr is that of this process. share_memory() replaces the pipes by shared memory.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/process/process.hpp"
#include "harness/process/shared_frames.hpp"

namespace attest {

// One thread at a time. Neither reading nor writing has a time limit. For a limit, use it in a
// process that can be killed; the program ends with that process.
class PipedProgram {
 public:
  // Ignores SIGPIPE in this process, so that a program that does not read is an error of write().
  static Result<PipedProgram> start(const std::vector<std::string>& command);

  // For tests: recorded answers instead of a process. Takes both descriptors. The answers are a
  // file, whose end is the end of the program.
  static PipedProgram recorded(int requests, int answers);

  PipedProgram(PipedProgram&& other) noexcept;
  PipedProgram& operator=(PipedProgram&&) = delete;
  ~PipedProgram();  // end()

  // From now on write() writes a frame to the shared memory, and read() reads the answer to it
  // there. False: there is no memory, as with recorded answers.
  bool share_memory();

  // Writes all. Keeps what the program writes meanwhile, so that neither waits for the other.
  // False: the program does not read any more.
  bool write(std::string_view bytes);

  // Reads exactly `size` bytes. False: the program has ended or closed its stdout before.
  bool read(void* place, std::size_t size);

  // Reads until the next line feed, which is left out. Empty: the program has ended or closed its
  // stdout before, or the line is longer than `most`.
  std::optional<std::string> read_line(std::size_t most);

  // The bytes that the program has written and that no read() or read_line() has returned.
  std::string_view unread() const { return {inbox_.data() + begin_, end_ - begin_}; }

  // How the program ended, after read() or read_line() has failed: "exited with status 1", "was
  // killed by signal 11 (Segmentation fault)". A program that still runs is killed, and the text is
  // "closed its stdout".
  std::string end();

 private:
  PipedProgram(Process process, int requests, int answers)
      : process_(std::move(process)), requests_(requests), answers_(answers) {}

  bool write_to_pipe(std::string_view bytes);
  bool read_from_pipe(void* place, std::size_t size);
  bool receive();  // more bytes into the inbox; false: there are no more

  Process process_;
  int requests_, answers_;  // our ends of the pipes
  std::vector<char> inbox_;
  std::size_t begin_ = 0, end_ = 0;  // of what was read from the pipe and not used yet
  std::optional<SharedFrames> memory_;
  bool is_shared_ = false;
};

}  // namespace attest
