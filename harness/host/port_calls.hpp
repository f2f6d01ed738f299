// The call of the port that runs now, in memory that the port's process shares with its judge.
// After a crash or a timeout the judge reads there in which call, and at which tick, the port was.
// While the judge waits for a program, it sees there whether the program still answers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "harness/core/result.hpp"
#include "harness/port/port.hpp"

namespace attest {

class PortCalls {
 public:
  // Errors: no shared memory.
  static Result<PortCalls> make();

  // Forgets the calls of a process that has ended.
  void reset() const;

  // " in step() at tick 17", " in create()"; empty between the calls. In a live flight of the
  // cascade two calls may run at the same time. The port can overwrite this memory, so only
  // messages may depend on it.
  std::string current() const;

  // How many calls have begun so far.
  std::uint64_t count() const;

  // Returns `port`, with create() and each call of its units noted. For use in the port's process.
  // This object and `port` must outlive the result. A single `unit` is noted as a controller.
  std::unique_ptr<Port> noted(Port& port) const;
  std::unique_ptr<Unit> noted(std::unique_ptr<Unit> unit) const;

  struct Now;

 private:
  struct Unmap {
    void operator()(Now* now) const;
  };
  explicit PortCalls(Now* now) : now_(now) {}

  std::unique_ptr<Now, Unmap> now_;
};

}  // namespace attest
