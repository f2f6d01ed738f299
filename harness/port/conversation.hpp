// The requests to a running program, and its answers (PROTOCOL.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/port/hello.hpp"
#include "harness/port/port.hpp"
#include "harness/process/piped_program.hpp"
#include "harness/trace/channels.hpp"

namespace attest {

// The kinds of requests, with their numbers in binary frames. Error messages name the kind.
enum class Request : std::uint32_t { create = 1, destroy, set_parameter, step, batch };
std::string_view name_of(Request request);  // "set_parameter"

inline constexpr std::size_t max_batch = 1024;      // steps in one request
inline constexpr std::size_t max_line = 64u << 10;  // bytes of a handshake or a text frame

// One step: timestamp_sample, then inputs and outputs of a module in the sample, and its cost.
struct ProgramStep {
  std::uint64_t timestamp_sample_us = 0;
  Sample sample{};
  StepCost cost{};  // of an answer ATTEST_OK if hello().cost; otherwise undefined
};

// A program that has answered the handshake. A function that sends a request throws PortBroke if
// the program has ended, or if its answer breaks the rules. After that is_over() is true, and no
// request may follow.
//
// A program answers one request at a time. Units that may be stepped on two threads lock `mutex()`
// for a request and its answer. Conversation itself does not lock it.
class Conversation {
 public:
  // Makes the handshake. Errors: the program cannot be started, it ended, its answer is not valid.
  static Result<std::unique_ptr<Conversation>> begin(const std::vector<std::string>& command);
  static Result<std::unique_ptr<Conversation>> begin(PipedProgram program);

  virtual ~Conversation() = default;

  const Hello& hello() const { return hello_; }
  bool is_over() const { return is_over_; }
  std::mutex& mutex() { return mutex_; }

  // destroy() for a destructor: throw_late() throws the exception of destroy(), if there was one.
  void destroy_quietly(std::uint32_t unit) noexcept;
  void throw_late();

  // Each returns the program's result: ATTEST_OK, or another number.
  virtual int create(std::uint32_t unit, Module module, const std::string& profile,
                     const std::string& definition) = 0;
  virtual int destroy(std::uint32_t unit) = 0;
  virtual int set_parameter(std::uint32_t unit, const std::string& name, float value) = 0;
  // Replaces the outputs. In a text frame, an output that the program leaves out keeps its value,
  // but a flag `published` becomes 0.
  virtual int step(std::uint32_t unit, Module module, ProgramStep& step) = 0;
  // Sets `done` to the number of steps that have outputs. REQUIRES: hello().has_batch, 1 to
  // max_batch steps.
  virtual int batch(std::uint32_t unit, Module module, std::span<ProgramStep> steps,
                    std::size_t& done);

 protected:
  Conversation(PipedProgram program, Hello hello)
      : program_(std::move(program)), hello_(std::move(hello)) {}

  PipedProgram& program() { return program_; }
  std::uint32_t next_sequence() { return ++sequence_; }
  // ended() and broken() throw PortBroke.
  [[noreturn]] void ended(Request request);
  [[noreturn]] void broken(Request request, const std::string& what);

 private:
  PipedProgram program_;
  Hello hello_;
  std::uint32_t sequence_ = 0;
  std::optional<PortBroke> late_;
  bool is_over_ = false;
  std::mutex mutex_;
};

std::unique_ptr<Conversation> binary_conversation(PipedProgram program, Hello hello);
std::unique_ptr<Conversation> text_conversation(PipedProgram program, Hello hello);

}  // namespace attest
