// A program that reads requests on stdin and answers on stdout. Both are pipes to this process. The
// program writes to the stderr of this process. share_memory() replaces the pipes by shared memory.
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

// One thread at a time. Neither reading nor writing has a time limit. For a limit, use this class
// in a process that can be killed; the program ends with that process.
class PipedProgram {
 public:
  // Makes this process ignore SIGPIPE, so that write() returns false when the program has closed
  // its stdin.
  static Result<PipedProgram> start(const std::vector<std::string>& command);

  // For tests, without a process: `answers` is a file with recorded answers. Its end counts as the
  // end of the program. Takes ownership of both descriptors.
  static PipedProgram recorded(int requests, int answers);

  PipedProgram(PipedProgram&& other) noexcept;
  PipedProgram& operator=(PipedProgram&&) = delete;
  ~PipedProgram();  // end()

  // From now on write() writes a frame to the shared memory, and read() reads the answer to it
  // there. False: there is no shared memory, as after recorded().
  bool share_memory();

  // Writes all bytes. While the pipe is full, reads and keeps what the program writes, so that the
  // two processes do not block each other. False: the program has ended or closed a pipe, or the
  // shared memory has no room for the bytes.
  bool write(std::string_view bytes);

  // Reads exactly `size` bytes. False: the program has ended or closed its stdout before, or the
  // shared memory has no room for so many bytes.
  bool read(void* place, std::size_t size);

  // Reads until the next line feed, which is left out. Empty: the program has ended or closed its
  // stdout before, or the line is longer than `most`.
  std::optional<std::string> read_line(std::size_t most);

  // The bytes that the program has written and that no read() or read_line() has returned.
  std::string_view unread() const { return {inbox_.data() + begin_, end_ - begin_}; }

  // Closes the pipes, waits up to one second for the end of the program, and returns how it ended:
  // "exited with status 1", "was killed by signal 11 (Segmentation fault)". Kills a program that
  // still runs then, and returns "closed its stdout". A second call returns "has ended".
  std::string end();

 private:
  PipedProgram(Process process, int requests, int answers)
      : process_(std::move(process)), requests_(requests), answers_(answers) {}

  bool write_to_pipe(std::string_view bytes);
  bool read_from_pipe(void* place, std::size_t size);
  bool receive();  // reads more bytes into inbox_; false: there are no more

  Process process_;
  int requests_, answers_;  // our ends of the pipes
  std::vector<char> inbox_;
  std::size_t begin_ = 0, end_ = 0;  // of the unused bytes in inbox_
  std::optional<SharedFrames> memory_;
  bool is_shared_ = false;
};

}  // namespace attest
